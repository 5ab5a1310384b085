"""What no hub for a class may do, wherever it runs: it then does not start, and says why.

The hub of one machine imports it, and that of Kubernetes, into whose pod the chart puts this file.
"""

import sys
from contextlib import suppress
from importlib.metadata import entry_points

from jupyterhub import auth
from jupyterhub.authenticators.shared import SharedPasswordAuthenticator
from traitlets import import_item

# The settings by which an authenticator names the house whose people it knows.
HOUSES = [
    *("hosted_domain", "tenant_id", "allowed_idps", "identity_provider"),  # one of many houses
    *(
        "authorize_url",
        "github_url",
        "gitlab_url",
        "okta_domain",
        "auth0_domain",
    ),  # its own sign-on
    *("issuer", "consumers"),  # a learning platform
    "server_address",  # a directory
]


def refuse(sentence):
    """End here, with what the owner has to set."""
    sys.exit(f"The hub does not start: {sentence}")


def chosen(c, kind, value):
    """Find the class of an authenticator or a spawner, and its settings."""
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


def people(c):
    """Refuse a way in for whom nobody knows; return who looks after the class."""
    if c.JupyterHub.get("authenticator_class") in (None, "", "null"):
        refuse("set c.JupyterHub.authenticator_class: how is a student to prove who they are?")
    authenticator, who = chosen(c, "authenticator", c.JupyterHub.authenticator_class)
    name = authenticator.__name__
    if issubclass(authenticator, (auth.DummyAuthenticator, SharedPasswordAuthenticator)):
        refuse(f"with {name} anybody can come in as anybody.")
    if not any(value for key, value in who.items() if key.startswith("allow")):
        refuse(f"nobody may come in. Set allowed_users, or another allow… of {name}.")
    # All may come in where all are of one house: whoever has a password of this machine, or is of
    # the house that the settings name. Any other may make a user of whoever comes.
    house = issubclass(authenticator, auth.PAMAuthenticator) or any(map(who.get, HOUSES))
    if who.get("open_signup") or (who.get("allow_all") and not house):
        refuse(f"anybody in the world could come in. Have {name} allow your students alone.")
    if not who.get("admin_users") and not who.get("admin_groups"):
        refuse("set c.Authenticator.admin_users: who looks after the class?")
    return who.get("admin_users")


def pages_of_others(c):
    """Refuse to open the students' servers to other people's pages."""
    _, how = chosen(c, "spawner", c.JupyterHub.spawner_class)
    for setting in ("allow_origin", "disable_check_xsrf", "Access-Control-Allow-Origin"):
        if setting in repr([how, c.JupyterHub, c.get("ServerApp")]):
            refuse(f"{setting} opens the students' servers to other people's pages. Take it out.")


def pods(c, value):
    """Refuse what no pod of a student may be; the chart's `get_config` gives its values."""
    name = value("singleuser.image.name", "")
    if not name.endswith("@sha256") or len(value("singleuser.image.tag", "")) != 64:
        refuse("set singleuser.image to the image of the course, pinned by its digest.")
    spawner = c.KubeSpawner
    for limit in ("mem_limit", "mem_guarantee", "cpu_limit", "cpu_guarantee"):
        if not spawner.get(limit):
            refuse(f"{limit} of a student's pod is not set: one could take the machine of all.")
    if spawner.get("uid") == 0 or spawner.get("privileged") or spawner.get("service_account"):
        refuse("a student's pod must have a user that is not root, and no service account.")
    if spawner.get("allow_privilege_escalation") is not False:
        refuse("set singleuser.allowPrivilegeEscalation to false.")
    tls = value("proxy.https.enabled", False) and (
        value("proxy.https.type", "") == "offload" or value("proxy.https.hosts", [])
    )
    if not tls and not value("ingress.tls", []):
        refuse("passwords would cross the network in the open. Set proxy.https.hosts.")
    if not value("singleuser.networkPolicy.enabled", False):
        refuse("set singleuser.networkPolicy.enabled: a pod could reach the rest of the cluster.")
