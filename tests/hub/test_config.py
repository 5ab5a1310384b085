"""The hub's configuration: what it gives a class, and what it does not start with."""

import runpy
from pathlib import Path

import pytest
from classroom import CONFIG
from traitlets.config import PyFileConfigLoader

PAM = """
c.JupyterHub.authenticator_class = "pam"
c.PAMAuthenticator.allowed_groups = {"ik-course"}
c.Authenticator.admin_users = {"ada"}
"""
TLS = """
c.JupyterHub.ssl_key = "hub.key"
c.JupyterHub.ssl_cert = "hub.pem"
"""
GITHUB = """
from jupyterhub.auth import Authenticator
class GitHubOAuthenticator(Authenticator): ...
c.JupyterHub.authenticator_class = GitHubOAuthenticator
c.Authenticator.allow_all = True
c.Authenticator.admin_users = {"ada"}
"""
BEHIND = 'c.JupyterHub.bind_url = "http://127.0.0.1:8000"'

REFUSED = {
    "": "authenticator_class",
    PAM: "ssl_key",
    PAM + TLS.replace("ssl_key", "ssl_kez"): "ssl_key",
    PAM + BEHIND.replace("127.0.0.1", "0.0.0.0"): "ssl_key",
    PAM.replace("pam", "dummy") + TLS: "anybody can come in as anybody",
    PAM.replace("pam", "jupyterhub.auth.DummyAuthenticator") + TLS: "anybody",
    PAM.replace("pam", "shared-password") + TLS: "anybody can come in as anybody",
    PAM.replace("pam", "no.such.Thing") + TLS: "no authenticator 'no.such.Thing'",
    PAM.replace("pam", "nothing") + TLS: "installed are .*pam",
    PAM.replace("allowed_groups", "pam_groups") + TLS: "nobody may come in",
    PAM.replace("admin_users", "blocked_users") + TLS: "admin_users",
    PAM + TLS + "c.PAMAuthenticator.open_signup = True": "anybody in the world",
    GITHUB + TLS: "anybody in the world",
    PAM.replace("pam", "os.path") + TLS: "no authenticator",
    PAM + TLS + 'c.JupyterHub.spawner_class = "simple"': "share the account",
    PAM + TLS + 'c.Spawner.args.append("--ServerApp.allow_origin=*")': "allow_origin",
    PAM + TLS + 'c.SystemdSpawner.args = ["--ServerApp.allow_origin=*"]': "allow_origin",
    PAM + TLS + "c.ServerApp.disable_check_xsrf = True": "disable_check_xsrf",
}


def load(settings: str, folder: Path, monkeypatch):
    own = folder / "class.py"
    own.write_text(settings)
    monkeypatch.setenv("IKTEACH_CLASS", str(own))
    return PyFileConfigLoader(str(CONFIG)).load_config()


@pytest.mark.parametrize(("settings", "words"), REFUSED.items(), ids=range(len(REFUSED)))
def test_it_refuses_in_a_sentence_what_is_not_for_a_class(settings, words, tmp_path, monkeypatch):
    with pytest.raises(SystemExit, match=f"^The hub does not start: .*{words}"):
        load(settings, tmp_path, monkeypatch)


def test_it_asks_for_the_file_of_settings(tmp_path, monkeypatch):
    monkeypatch.setenv("IKTEACH_CLASS", str(tmp_path / "none.py"))
    with pytest.raises(SystemExit, match=r"there is no .*none.py"):
        PyFileConfigLoader(str(CONFIG)).load_config()


@pytest.mark.parametrize(
    "settings", [PAM + TLS, PAM + BEHIND, GITHUB.replace("all = True", "ed_users = {'bo'}") + TLS]
)
def test_it_starts_with_what_a_class_needs(settings, tmp_path, monkeypatch):
    c = load(settings, tmp_path, monkeypatch)
    assert c.Spawner.mem_limit
    assert c.Spawner.cpu_limit
    assert c.Spawner.environment["OPENBLAS_NUM_THREADS"] == "1"
    assert [service["name"] for service in c.JupyterHub.services] == ["idle-culler"]


def test_what_the_owner_sets_wins_and_is_added(tmp_path, monkeypatch):
    more = 'c.Spawner.mem_limit = "2G"\nc.Spawner.args.append("--debug")'
    c = load(PAM + TLS + more, tmp_path, monkeypatch)
    assert c.Spawner.mem_limit == "2G"
    assert len(c.Spawner.args) > 1
    assert c.Spawner.args[-1] == "--debug"


def test_systemd_can_fill_in_names(tmp_path, monkeypatch):
    """Its spawner formats each argument, so that braces of another kind would end it."""
    c = load(PAM + TLS, tmp_path, monkeypatch)
    for argument in [*c.Spawner.cmd, *c.Spawner.args]:
        assert argument.format(USERNAME="bo", USERID=1) == argument


def test_a_server_starts_where_the_course_cannot_be_written(tmp_path, monkeypatch, capsys):
    (tmp_path / "ikteach-course").write_text("a file in its place")
    monkeypatch.setenv("HOME", str(tmp_path))
    started = []
    monkeypatch.setattr("jupyterhub.singleuser.main", lambda: started.append(True))
    runpy.run_path(str(CONFIG.with_name("start.py")))
    assert started
    assert "could not be brought up to date: " in capsys.readouterr().err
