"""What stands in for a class's own settings when `hub.py` starts the hub on this machine alone.

It is no example for a class: all servers run on the account of whoever starts the bench.
"""

import json
import os
from hmac import compare_digest
from pathlib import Path

from jupyterhub.auth import Authenticator
from jupyterhub.spawner import LocalProcessSpawner

BENCH = json.loads(Path(os.environ["IKTEACH_BENCH"]).read_text())
PASSWORDS = BENCH["passwords"]  # one for each student, made up for this run


class Passwords(Authenticator):
    """Lets in whom the bench has made up."""

    async def authenticate(self, handler, data):
        right = PASSWORDS.get(data["username"])
        return data["username"] if right and compare_digest(right, data["password"]) else None


class Loopback(LocalProcessSpawner):
    """A home of their own for each student, but no account of their own."""

    def make_preexec_fn(self, name):
        home = Path(BENCH["homes"]) / name
        home.mkdir(exist_ok=True)
        return lambda: os.chdir(home)

    def user_env(self, env):
        return env | {"HOME": str(Path(BENCH["homes"]) / self.user.name)}


c = get_config()
c.JupyterHub.authenticator_class = Passwords
c.Passwords.allowed_users = set(PASSWORDS)
c.Passwords.admin_users = {"instructor"}
c.JupyterHub.spawner_class = Loopback
c.Spawner.args.append("--ServerApp.allow_root=True")
c.JupyterHub.bind_url = f"http://127.0.0.1:{BENCH['ports'][0]}"
c.JupyterHub.hub_port = BENCH["ports"][1]
c.ConfigurableHTTPProxy.api_url = f"http://127.0.0.1:{BENCH['ports'][2]}"
c.JupyterHub.log_level = "WARN"
