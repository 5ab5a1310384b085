"""The values for Kubernetes: the pod that KubeSpawner makes of them, and what their guard refuses.

No cluster is asked. `hub` does with the values what the chart's own configuration of the hub does
(Zero to JupyterHub, files/hub/jupyterhub_config.py, as far as these values go).
"""

import asyncio
import re
import sys
from copy import deepcopy
from pathlib import Path, PurePosixPath
from types import SimpleNamespace
from typing import Any

import hub as bench
import pytest
import yaml
from classroom import CONFIG, ROOT
from kubernetes_asyncio.client import ApiClient
from kubespawner import KubeSpawner
from test_config import PAM, TLS, load
from traitlets.config import Config

from binder.jupyterhub.kubernetes import machines

FOLDER = CONFIG.parent / "kubernetes"
sys.path.append(str(CONFIG.parent))  # where guard.py is, as in the pod of the hub
VALUES = yaml.safe_load((FOLDER / "values.yaml").read_text())
OWN = """
singleuser: {image: {name: registry.example.edu/ikteach@sha256, tag: "%s"}}
proxy: {https: {hosts: [hub.example.edu]}}
hub:
  config:
    JupyterHub: {authenticator_class: pam}
    PAMAuthenticator: {allowed_groups: [ik-course]}
    Authenticator: {admin_users: [ada]}
""" % ("5" * 64)

# Trait of the spawner -> where the chart has its value.
TRAITS = {
    "start_timeout": "startTimeout",
    "uid": "uid",
    "fs_gid": "fsGid",
    "service_account": "serviceAccountName",
    "allow_privilege_escalation": "allowPrivilegeEscalation",
    "mem_limit": "memory.limit",
    "mem_guarantee": "memory.guarantee",
    "cpu_limit": "cpu.limit",
    "cpu_guarantee": "cpu.guarantee",
    "environment": "extraEnv",
    "cmd": "cmd",
    "default_url": "defaultUrl",
    "storage_capacity": "storage.capacity",
}


def merged(below: Any, above: Any) -> Any:
    """As helm lays one file of values over another."""
    if not (isinstance(below, dict) and isinstance(above, dict)):
        return above
    return below | {key: merged(below.get(key), value) for key, value in above.items()}


def at(values: Any, place: str, default: Any = None) -> Any:
    """The value at a place such as "singleuser.memory.limit", as the chart's `get_config`."""
    for name in place.split("."):
        values = values.get(name) if isinstance(values, dict) else None
    return default if values is None else values


def hub(own: str = OWN, *, guarded: bool = True) -> Config:
    """The configuration of the hub, of our values under those of an owner."""
    values = merged(deepcopy(VALUES), yaml.safe_load(own))
    user, c = values["singleuser"], Config()
    c.JupyterHub.spawner_class = "kubespawner.KubeSpawner"
    for trait, place in TRAITS.items():
        if (value := at(user, place)) is not None:
            c.KubeSpawner[trait] = value
    c.KubeSpawner.image = f"{user['image']['name']}:{user['image']['tag']}"
    home = {"name": "volume-{user_server}", "persistentVolumeClaim": {"claimName": "{pvc_name}"}}
    c.KubeSpawner.volumes = [home]
    mount = {"mountPath": user["storage"]["homeMountPath"], "name": home["name"]}
    c.KubeSpawner.volume_mounts = [mount]
    for name, settings in values["hub"]["config"].items():
        c[name].update(settings)
    if guarded:
        for _, code in sorted(values["hub"]["extraConfig"].items()):
            exec(code, {"c": c, "get_config": lambda *place: at(values, *place)})
    return c


@pytest.fixture(scope="module")
def pod() -> Any:
    """What KubeSpawner asks the cluster for, when a student comes."""

    async def manifest() -> Any:
        made = await KubeSpawner(config=hub(), _mock=True).get_pod_manifest()
        async with ApiClient() as client:
            return client.sanitize_for_serialization(made)

    with pytest.MonkeyPatch.context() as patch:
        for name in ("load_config", "shared_client"):  # which look for a cluster
            patch.setattr(f"kubespawner.spawner.{name}", lambda *_, **__: None)
        return asyncio.run(manifest())


def test_a_student_has_what_was_measured_and_no_more(pod: Any) -> None:
    (container,) = pod["spec"]["containers"]
    assert container["resources"] == {
        "requests": {"cpu": 0.2, "memory": 512 * 2**20},
        "limits": {"cpu": 1.0, "memory": 2**30},
    }
    assert container["image"] == "registry.example.edu/ikteach@sha256:" + "5" * 64


def test_a_student_has_no_rights_over_machine_or_cluster(pod: Any) -> None:
    (container,) = pod["spec"]["containers"]
    assert container["securityContext"] == {
        "runAsUser": 1000,
        "runAsNonRoot": True,
        "allowPrivilegeEscalation": False,
        "capabilities": {"drop": ["ALL"]},
        "seccompProfile": {"type": "RuntimeDefault"},
    }
    assert pod["spec"]["automountServiceAccountToken"] is False
    assert not {"serviceAccountName", "hostNetwork", "hostPID", "hostIPC"} & set(pod["spec"])
    assert [set(volume) for volume in pod["spec"]["volumes"]] == [{"name", "persistentVolumeClaim"}]


def test_a_server_is_started_from_the_image_with_the_home_beside_it(pod: Any) -> None:
    (container,) = pod["spec"]["containers"]
    assert "command" not in container  # the image's entry: binder/start, which sets the threads
    python, script, *arguments = container["args"]
    clone = PurePosixPath("/srv/repo")
    assert python == "python"
    assert (ROOT / PurePosixPath(script).relative_to(clone)).is_file()
    assert set(VALUES["hub"]["config"]["KubeSpawner"]["args"]) <= set(arguments)
    (mount,) = container["volumeMounts"]
    assert not clone.is_relative_to(mount["mountPath"])  # or the home would hide the clone
    environment = {one["name"]: one.get("value") for one in container["env"]}
    assert environment["JUPYTERHUB_ROOT_DIR"] == "~/ikteach-course"
    kernels = PurePosixPath(environment["JUPYTER_PATH"]).relative_to(clone)
    assert (ROOT / kernels / "kernels" / "python3" / "kernel.json").is_file()
    told = (FOLDER / "README.md").read_text()
    for option in (f"--target-repo-dir {clone}", "--user-id 1000", "--user-name jovyan"):
        assert option in told


def test_the_same_holds_as_on_one_machine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one, here = load(PAM + TLS, tmp_path, monkeypatch), hub()
    for name in ("mem_limit", "cpu_limit", "notebook_dir", "default_url", "args"):
        assert here.KubeSpawner[name] == one.Spawner[name], name
    places = {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "JUPYTER_PATH"}
    assert set(here.KubeSpawner.environment) == set(one.Spawner.environment) == places
    assert here.KubeSpawner.http_timeout == one.Spawner.http_timeout
    ((culler,), cull) = one.JupyterHub.services, VALUES["cull"]
    assert cull["enabled"]
    assert {f"--timeout={cull['timeout']}", f"--max-age={cull['maxAge']}"} < set(culler["command"])


def test_pods_reach_the_hub_and_names_alone() -> None:
    user = VALUES["singleuser"]
    assert user["networkPolicy"]["enabled"]
    assert user["networkPolicy"]["egress"] == []
    opened = {
        rule for rule, is_open in user["networkPolicy"]["egressAllowRules"].items() if is_open
    }
    assert opened == {"dnsPortsKubeSystemNamespace", "dnsPortsPrivateIPs"}
    assert user["cloudMetadata"] == {"blockWithIptables": True, "ip": "169.254.169.254"}


def test_the_image_and_room_are_there_before_the_class() -> None:
    assert VALUES["prePuller"] == {"hook": {"enabled": True}, "continuous": {"enabled": True}}
    scheduling = VALUES["scheduling"]
    assert scheduling["userPlaceholder"]["replicas"] > 0
    assert scheduling["podPriority"]["enabled"]  # or placeholders would not give way


REFUSED = {
    "{}": "authenticator_class",  # as it is handed out
    OWN.replace("pam", '"null"'): "authenticator_class",
    OWN.replace("pam", "dummy"): "anybody can come in as anybody",
    OWN.replace("pam", "shared-password"): "anybody can come in as anybody",
    OWN.replace("allowed_groups", "pam_groups"): "nobody may come in",
    OWN.replace("admin_users", "blocked_users"): "admin_users",
    OWN.replace("@sha256", ""): "pinned by its digest",
    OWN.replace("5" * 64, "latest"): "pinned by its digest",
    OWN.replace("hub.example.edu", ""): "passwords would cross",
    OWN.replace("hosts:", "enabled: false, hosts:"): "passwords would cross",
    OWN + "    KubeSpawner: {privileged: true}": "not root",
    OWN + "    KubeSpawner: {uid: 0}": "not root",
    OWN + "    KubeSpawner: {mem_limit: null}": "mem_limit",
    OWN + "    KubeSpawner: {service_account: cluster-admin}": "service account",
    OWN + "    KubeSpawner: {allow_privilege_escalation: true}": "allowPrivilegeEscalation",
    OWN + '    KubeSpawner: {args: ["--ServerApp.allow_origin=*"]}': "allow_origin",
    OWN.replace("singleuser: {", "singleuser: {networkPolicy: {enabled: false}, "): "cluster",
    OWN.replace("singleuser: {", "singleuser: {cpu: {limit: 0}, "): "cpu_limit",
}


@pytest.mark.parametrize(("own", "words"), REFUSED.items(), ids=range(len(REFUSED)))
def test_the_hub_refuses_in_a_sentence_what_is_not_for_a_class(own: str, words: str) -> None:
    with pytest.raises(SystemExit, match=f"^The hub does not start: .*{words}"):
        hub(own)


@pytest.mark.parametrize(
    "own",
    [
        OWN,
        OWN.replace("hosts: [hub.example.edu]", "type: offload"),
        OWN.replace("hosts: [hub.example.edu]", "enabled: false")
        + "ingress: {tls: [{hosts: [hub.example.edu]}]}",
    ],
)
def test_the_hub_starts_with_what_a_class_needs(own: str) -> None:
    hub(own)


def test_without_its_guard_the_hub_does_not_start() -> None:
    guard = VALUES["hub"]["extraFiles"]["guard"]
    assert PurePosixPath(guard["mountPath"]).name == "guard.py"  # what zz-guard imports
    with pytest.raises(SystemExit, match=r"^The hub does not start: .*guard\.py"):
        exec(guard["stringData"], {})
    told = (FOLDER / "README.md").read_text()
    (path,) = re.findall(r"--set-file hub\.extraFiles\.guard\.stringData=(\S+)", told)
    assert (FOLDER / path).samefile(CONFIG.with_name("guard.py"))


def test_the_owner_s_file_in_the_readme_is_one_that_starts() -> None:
    told = (FOLDER / "README.md").read_text()
    (own,) = re.findall(r"```yaml\n(.*?)```", told, re.DOTALL)
    known = own.replace("the 64 digits", "5" * 64).replace("generic-oauth", "pam")
    hub(known.replace("GenericOAuthenticator", "PAMAuthenticator"))


def test_what_is_promised_is_what_was_measured() -> None:
    capacity = machines.measured(machines.TEACHING.read_text())
    pod = machines.promised(machines.VALUES.read_text())
    assert pod.cpu == pytest.approx(capacity.cpu)
    assert capacity.held <= pod.memory <= 1.25 * capacity.held
    assert pod.most_memory >= 2 * capacity.held
    assert (machines.RATE, machines.LATE) == (bench.RATE, bench.LATE)
    other = machines.TEACHING.read_text().replace("| 10 | 29.9 |", "| 10 | 19.9 |")
    assert machines.measured(other).cpu > pod.cpu


def test_the_reckoning_is_made_of_it_and_no_machine_is_too_full() -> None:
    pod = machines.promised(machines.VALUES.read_text())
    assert machines.reckoning(pod) in (FOLDER / "README.md").read_text()
    for cores, memory in machines.SIZES:
        students = machines.on_one(pod, cores, memory)
        assert students * pod.cpu <= cores - machines.OWN_CORES + 1e-9
        assert students * pod.memory <= 1024 * (memory - machines.OWN_MEMORY)
        assert students + 10 <= 110
    small = SimpleNamespace(cpu=0.01, memory=10)
    assert machines.on_one(small, 64, 256) == machines.PODS
