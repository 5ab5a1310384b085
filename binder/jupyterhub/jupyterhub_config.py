"""JupyterHub for a class on one machine. Nothing in here needs to be changed.

    pip install --editable '/srv/ikteach[hub]'; npm install --global configurable-http-proxy@5
    cd /srv/hub  # holds the hub's database and secrets: for root's eyes alone
    jupyterhub --config /srv/ikteach/binder/jupyterhub/jupyterhub_config.py

What only the owner of the hub can decide stands in a file of theirs, `class.py` in that folder or
where the variable IKTEACH_CLASS says. It is read below, may set whatever JupyterHub knows, and wins
over what is set here. For instance:

    c.JupyterHub.authenticator_class = "pam"           # how a student proves who they are
    c.PAMAuthenticator.allowed_groups = {"ik-course"}  # and who may come in
    c.Authenticator.admin_users = {"ada"}
    c.JupyterHub.ssl_key = "/etc/ssl/private/hub.key"  # or a bind_url on 127.0.0.1, for a web
    c.JupyterHub.ssl_cert = "/etc/ssl/certs/hub.pem"   # server on this machine that does TLS

The hub does not start, and says why, where that file leaves out what a class needs, or would let in
people whom nobody knows.
"""

import os
import sys
from contextlib import suppress
from importlib.metadata import entry_points
from pathlib import Path
from urllib.parse import urlsplit

from jupyterhub import auth, spawner
from jupyterhub.authenticators.shared import SharedPasswordAuthenticator
from traitlets import import_item

c = get_config()
HERE = Path(__file__).resolve().parent

# A student's server: the course, brought up to date and never overwritten, in a folder of theirs.
# start.py does that as the student. (nbgitpuller does it too, from a git repository and by a link:
# then set cmd = ["jupyterhub-singleuser"], notebook_dir = "" and default_url = "/lab" in yours. The
# sockets of kernels then lie in the homes, the path of which may have 28 characters.)
c.Spawner.cmd = [sys.executable, str(HERE / "start.py")]
c.Spawner.notebook_dir = "~/ikteach-course"
c.Spawner.default_url = "/lab/tree/00_figure.ipynb"
c.Spawner.args = [
    "--ServerApp.jpserver_extensions=ikteach.server=True",  # frames in time
    # Kernels take no ports: of twenty that start at once, two may choose the same one, and a kernel
    # that finds its port taken dies. And a port is open to everybody on the machine.
    "--KernelManager.transport=ipc",
    "--MappingKernelManager.cull_idle_timeout=3600",  # [s] kernels that no page looks at
    "--LabApp.news_url=None",
    "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
]
c.Spawner.environment = {
    # Matrices of a figure are small: more threads only make the students wait for one another.
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    # Kernels, which make frames, give way to servers and proxy, which deliver them (kernels/):
    # where the machine is too small for a class, there are fewer frames, and none come late.
    "JUPYTER_PATH": str(HERE),
}
c.Spawner.start_timeout = c.Spawner.http_timeout = 180  # [s] a whole class logs in at once

# Limits. A server takes about 110 MB, and each open chapter about as much again. It is the spawner
# that enforces them, and not every one does: systemd's and Docker's do, by control groups of the
# kernel; JupyterHub's own LocalProcessSpawner only tells the server the numbers.
c.JupyterHub.spawner_class = "systemd"  # needs for each student an account of the system
c.SystemdSpawner.isolate_tmp = True
c.Spawner.mem_limit = "1G"
c.Spawner.cpu_limit = 1.0  # cores

# Stop servers that nobody has used for an hour, and those of pages left playing after ten.
c.JupyterHub.load_roles = [
    {
        "name": "idle-culler",
        "scopes": ["list:users", "read:users:activity", "read:servers", "delete:servers"],
        "services": ["idle-culler"],
    }
]
CULLER = [sys.executable, "-m", "jupyterhub_idle_culler", "--timeout=3600", "--max-age=36000"]
c.JupyterHub.services = [{"name": "idle-culler", "command": CULLER}]


def refuse(sentence):
    """End here, with what the owner has to set."""
    sys.exit(f"The hub does not start: {sentence}")


OWNERS = Path(os.environ.get("IKTEACH_CLASS", "class.py")).resolve()
if not OWNERS.is_file():
    refuse(f"there is no {OWNERS}. Name the file of your settings in IKTEACH_CLASS.")
load_subconfig(str(OWNERS))


def chosen(kind, value):
    """The class that an authenticator or a spawner is, and what is set for it and its bases."""
    known = {entry.name: entry for entry in entry_points(group=f"jupyterhub.{kind}s")}
    if isinstance(value, str):
        with suppress(ImportError, ValueError):  # then it stays a word
            value = known[value].load() if value in known else import_item(value)
    if not isinstance(value, type):
        refuse(f"there is no {kind} {value!r}; installed are {', '.join(sorted(known))}.")
    settings = {}
    for base in reversed(value.mro()):
        settings.update(c.get(base.__name__, {}))
    return value, settings


hub = c.JupyterHub
if not hub.get("authenticator_class"):
    refuse("set c.JupyterHub.authenticator_class: how is a student to prove who they are?")
authenticator, who = chosen("authenticator", hub.authenticator_class)
name = authenticator.__name__
if issubclass(authenticator, (auth.DummyAuthenticator, SharedPasswordAuthenticator)):
    refuse(f"with {name} anybody can come in as anybody.")
if not any(value for key, value in who.items() if key.startswith("allow")):
    refuse(f"nobody may come in. Set allowed_users, or another allow… of {name}.")
public = any(provider in name for provider in ("Bitbucket", "GitHub", "Globus", "Google"))
if who.get("open_signup") or (public and who.get("allow_all") and not who.get("hosted_domain")):
    refuse(f"anybody in the world could come in. Have {name} allow your students alone.")
if not who.get("admin_users") and not who.get("admin_groups"):
    refuse("set c.Authenticator.admin_users: who looks after the class?")

runs, how = chosen("spawner", hub.spawner_class)
if issubclass(runs, spawner.SimpleLocalProcessSpawner):
    refuse("with SimpleLocalProcessSpawner all students share the account of the hub.")
for setting in ("allow_origin", "disable_check_xsrf", "Access-Control-Allow-Origin"):
    if setting in repr([how, hub, c.get("ServerApp")]):
        refuse(f"{setting} opens the students' servers to other people's pages. Take it out.")

inside = urlsplit(hub.get("bind_url", "")).hostname in ("127.0.0.1", "::1", "localhost")
if not inside and not (hub.get("ssl_key") and hub.get("ssl_cert")):
    refuse(
        "passwords would cross the network in the open. Set ssl_key and ssl_cert, or set bind_url "
        "to http://127.0.0.1:8000 and put a web server with TLS before it."
    )
