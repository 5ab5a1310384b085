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
import pwd
import stat
import sys
from contextlib import suppress
from itertools import chain
from pathlib import Path
from urllib.parse import urlsplit

from jupyterhub import spawner

sys.path.insert(0, str(Path(__file__).resolve().parent))

from guard import chosen, pages_of_others, people, refuse

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
    "--ServerApp.jpserver_extensions=ikteach.serve.extension=True",  # frames in time
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
c.SystemdSpawner.unit_extra_properties = {
    "TasksMax": "512",  # processes and threads: a server, and a kernel for each chapter, have 200
    "LimitFSIZE": "2G",  # one file; how much a student may keep in all is the file system's quota
    "MemorySwapMax": "0",  # whose memory is full does not have the machine swap for all
}
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


OWNERS = Path(os.environ.get("IKTEACH_CLASS", "class.py")).resolve()
if not OWNERS.is_file():
    refuse(f"there is no {OWNERS}. Name the file of your settings in IKTEACH_CLASS.")
load_subconfig(str(OWNERS))


def changeable(path, folders, admins):
    """Whether somebody who is no admin may write to a path; in a folder also: replace its files."""
    found = path.stat()
    with suppress(KeyError):  # whom the system does not know, nobody is
        owner = pwd.getpwuid(found.st_uid).pw_name
        if found.st_uid not in (0, os.geteuid()) and repr(owner) not in repr(admins):
            return True
    by_group = found.st_mode & stat.S_IWGRP and found.st_gid not in (0, os.getegid())
    sticky = found.st_mode & stat.S_ISVTX and path not in folders  # as /tmp is, above a folder
    return bool((by_group or found.st_mode & stat.S_IWOTH) and not sticky)


admins = people(c)
hub = c.JupyterHub
runs, _ = chosen(c, "spawner", hub.spawner_class)
if issubclass(runs, spawner.SimpleLocalProcessSpawner):
    refuse("with SimpleLocalProcessSpawner all students share the account of the hub.")
pages_of_others(c)

# What the hub runs, as root, must be out of the students' reach.
CLONE = HERE.parents[1]
folders = [OWNERS.parent, Path.cwd(), Path(sys.prefix).resolve(), CLONE]
above = (path for folder in folders for path in (folder, *folder.parents))
trees = [CLONE / name for name in ("binder", "ikteach", "notebooks")]
for path in chain([OWNERS, *trees], above, *(tree.rglob("*") for tree in trees)):
    if path.exists() and changeable(path, folders, admins):
        refuse(f"others may change {path}: chown it to root, and chmod go-w.")

inside = urlsplit(hub.get("bind_url", "")).hostname in ("127.0.0.1", "::1", "localhost")
if not inside and not (hub.get("ssl_key") and hub.get("ssl_cert")):
    refuse(
        "passwords would cross the network in the open. Set ssl_key and ssl_cert, or set bind_url "
        "to http://127.0.0.1:8000 and put a web server with TLS before it."
    )
if not hub.get("subdomain_host"):
    print(
        "All pages have the hub's own origin: what a student's page does, an admin who opens that "
        "student's server does. Open it as somebody who is no admin, or set subdomain_host, which "
        "needs a wildcard in the DNS and in the certificate.",
        file=sys.stderr,
    )
