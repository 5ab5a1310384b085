"""The hub's configuration: what it gives a class, and what it does not start with."""

import os
import runpy
import shutil
from pathlib import Path
from types import SimpleNamespace

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

# Authenticators of other packages; what matters is which of them let in whoever comes.
OTHER = """
from jupyterhub.auth import Authenticator, LocalAuthenticator
class {0}(Authenticator): ...
c.JupyterHub.authenticator_class = {0}
c.{0}.allow_all = True
c.Authenticator.admin_users = {{"ada"}}
"""
GITHUB = OTHER.format("GitHubOAuthenticator")
LTI = OTHER.format("LTI13Authenticator") + 'c.LTI13Authenticator.issuer = "https://moodle.edu"'
GOOGLE = OTHER.format("GoogleOAuthenticator") + 'c.GoogleOAuthenticator.hosted_domain = ["a.edu"]'
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
    **{
        OTHER.format(name) + TLS: f"anybody in the world .* Have {name} allow"
        for name in ("TmpAuthenticator", "FirstUseAuthenticator", "NativeAuthenticator", "OfATest")
    },
    GITHUB.replace("(Authenticator)", "(LocalAuthenticator)") + TLS: "anybody in the world",
    OTHER.format("Tmp").replace("c.Tmp.allow", "c.Authenticator.allow") + TLS: "anybody in the",
    PAM.replace("pam", "os.path") + TLS: "no authenticator",
    PAM + TLS + 'c.JupyterHub.spawner_class = "simple"': "share the account",
    PAM + TLS + 'c.Spawner.args.append("--ServerApp.allow_origin=*")': "allow_origin",
    PAM + TLS + 'c.SystemdSpawner.args = ["--ServerApp.allow_origin=*"]': "allow_origin",
    PAM + TLS + "c.ServerApp.disable_check_xsrf = True": "disable_check_xsrf",
}


def load(settings: str, folder: Path, monkeypatch, config: Path = CONFIG):
    own = folder / "class.py"
    own.write_text(settings)
    monkeypatch.setenv("IKTEACH_CLASS", str(own))
    return PyFileConfigLoader(str(config)).load_config()


@pytest.mark.parametrize(("settings", "words"), REFUSED.items(), ids=range(len(REFUSED)))
def test_it_refuses_in_a_sentence_what_is_not_for_a_class(settings, words, tmp_path, monkeypatch):
    with pytest.raises(SystemExit, match=f"^The hub does not start: .*{words}"):
        load(settings, tmp_path, monkeypatch)


def test_it_asks_for_the_file_of_settings(tmp_path, monkeypatch):
    monkeypatch.setenv("IKTEACH_CLASS", str(tmp_path / "none.py"))
    with pytest.raises(SystemExit, match=r"there is no .*none.py"):
        PyFileConfigLoader(str(CONFIG)).load_config()


@pytest.mark.parametrize(
    "settings",
    [
        PAM + TLS,
        PAM + BEHIND,
        GITHUB.replace("all = True", "ed_users = {'bo'}") + TLS,
        PAM + TLS + "c.PAMAuthenticator.allow_all = True",
        LTI + TLS,
        GOOGLE + TLS,
        OTHER.format("Tmp").replace("all = True", "ed_users = {'bo'}") + TLS,
    ],
)
def test_it_starts_with_what_a_class_needs(settings, tmp_path, monkeypatch):
    c = load(settings, tmp_path, monkeypatch)
    assert c.Spawner.mem_limit
    assert c.Spawner.cpu_limit
    assert {"TasksMax", "LimitFSIZE"} <= set(c.SystemdSpawner.unit_extra_properties)
    assert c.Spawner.environment["OPENBLAS_NUM_THREADS"] == "1"
    assert [service["name"] for service in c.JupyterHub.services] == ["idle-culler"]


@pytest.mark.parametrize("mode", [0o757, 0o777, 0o1777])
def test_it_refuses_where_others_may_change_the_settings(mode, tmp_path, monkeypatch):
    (folder := tmp_path / "hub").mkdir()
    folder.chmod(mode)
    with pytest.raises(SystemExit, match=f"others may change {folder}: chown"):
        load(PAM + TLS, folder, monkeypatch)
    folder.chmod(0o755)
    load(PAM + TLS, folder, monkeypatch)
    (folder / "class.py").chmod(0o646)
    with pytest.raises(SystemExit, match=r"others may change .*class.py: chown"):
        load(PAM + TLS, folder, monkeypatch)
    (folder / "class.py").chmod(0o644)
    folder.parent.chmod(0o703)
    with pytest.raises(SystemExit, match=f"others may change {tmp_path}: chown"):
        load(PAM + TLS, folder, monkeypatch)
    folder.parent.chmod(0o1703)  # as /tmp is
    load(PAM + TLS, folder, monkeypatch)


def test_it_refuses_a_clone_that_others_may_change(tmp_path, monkeypatch):
    shutil.copytree(CONFIG.parent, tmp_path / "binder" / "jupyterhub")
    config = tmp_path / "binder" / "jupyterhub" / CONFIG.name
    (notebooks := tmp_path / "notebooks").mkdir()
    load(PAM + TLS, tmp_path, monkeypatch, config)
    notebooks.chmod(0o757)
    with pytest.raises(SystemExit, match=f"others may change {notebooks}: chown"):
        load(PAM + TLS, tmp_path, monkeypatch, config)


def test_a_folder_may_be_an_admin_s_and_no_other_s(tmp_path, monkeypatch):
    """Every file here is then of somebody who is neither root nor the hub."""
    monkeypatch.setattr("os.geteuid", lambda: -1)
    stat = Path.stat
    facts = ("st_mode", "st_gid")

    def owned(path, **options):
        found = stat(path, **options)
        return SimpleNamespace(st_uid=12345, **{fact: getattr(found, fact) for fact in facts})

    monkeypatch.setattr(Path, "stat", owned)
    monkeypatch.setattr("pwd.getpwuid", lambda uid: SimpleNamespace(pw_name="bo"))
    with pytest.raises(SystemExit, match=f"others may change {tmp_path}/class.py"):
        load(PAM + TLS, tmp_path, monkeypatch)
    load(PAM.replace("ada", "bo") + TLS, tmp_path, monkeypatch)


def test_it_says_whose_origin_the_pages_have(tmp_path, monkeypatch, capsys):
    load(PAM + TLS, tmp_path, monkeypatch)
    assert "subdomain_host" in capsys.readouterr().err
    named = 'c.JupyterHub.subdomain_host = "https://hub.example.edu"'
    load(PAM + TLS + named, tmp_path, monkeypatch)
    assert capsys.readouterr().err == ""


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


def test_what_a_student_has_is_for_no_other_to_read(tmp_path, monkeypatch):
    (course := tmp_path / "ikteach-course").mkdir(mode=0o755)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr("jupyterhub.singleuser.main", lambda: (course / "answers").touch())
    before = os.umask(0o022)
    try:
        runpy.run_path(str(CONFIG.with_name("start.py")))
    finally:
        os.umask(before)
    assert course.stat().st_mode & 0o777 == 0o700
    for one in course.rglob("*"):
        assert not one.stat().st_mode & 0o077, one
