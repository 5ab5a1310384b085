"""What Binder is told: pins within the ranges, layers in a good order, links that lead."""

import re
import tomllib
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

from binder import links, recipe

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
ADDRESS = "https://github.com/someone/ikteach"
HUB = "https://hub.example.edu"


def wanted(extra: str) -> list[Requirement]:
    """What the package needs with an extra, other extras of its own resolved."""
    found: list[Requirement] = []
    for text in PROJECT["optional-dependencies"][extra]:
        requirement = Requirement(text)
        if requirement.name == PROJECT["name"]:
            found += [one for other in requirement.extras for one in wanted(other)]
        else:
            found.append(requirement)
    return found


def pins() -> dict[str, str]:
    """Name -> version, of each line that is no comment."""
    lines = (ROOT / "binder" / "requirements.txt").read_text(encoding="utf-8").splitlines()
    parts = [line.partition("==") for line in lines if not line.startswith("#")]
    assert all(name and version for name, _, version in parts), "a line that is no pin"
    return {canonicalize_name(name): version for name, _, version in parts}


def test_every_requirement_is_pinned_within_its_range() -> None:
    pinned = pins()
    requirements = [Requirement(text) for text in PROJECT["dependencies"]] + wanted("binder")
    assert len(requirements) > 8
    for requirement in requirements:
        version = pinned.get(canonicalize_name(requirement.name))
        assert version is not None, f"{requirement.name} has no pin"
        assert version in requirement.specifier, f"{requirement.name}=={version}: {requirement}"


def test_the_package_itself_is_not_among_the_pins() -> None:
    assert PROJECT["name"] not in pins()  # or every commit would have the packages installed anew


def test_the_recipe_installs_the_packages_before_it_copies_the_repository() -> None:
    python, layers = recipe.recipe(ROOT)
    assert python == (ROOT / "binder" / "runtime.txt").read_text().strip().removeprefix("python-")
    assert python in SpecifierSet(PROJECT["requires-python"])
    assert layers == [
        ("COPY", "src/binder/requirements.txt ${REPO_DIR}/binder/requirements.txt"),
        ("RUN", f'{recipe.PIP} -r "binder/requirements.txt"'),
        ("COPY", "src/ ${REPO_DIR}/"),
        ("RUN", "chmod +x binder/postBuild"),
        ("RUN", "./binder/postBuild"),
        ("RUN", 'chmod +x "${REPO_DIR}/binder/start"'),
        ("ENV", 'R2D_ENTRYPOINT="${REPO_DIR}/binder/start"'),
    ]


def test_no_recipe_lowers_the_server_s_guard() -> None:
    for file in (ROOT / "binder").rglob("*"):
        if "jupyterhub" in file.parts:
            continue  # tests/hub has its own, by which it refuses them
        if file.is_file() and file.suffix != ".pyc":
            said = re.search(r"token=['\"]{2}|token=$|allow_origin|disable_check_xsrf|password",
                             file.read_text(encoding="utf-8"))  # fmt: skip
            assert said is None, f"{file}: {said}"


def opened(text: str) -> list[str]:
    """The files that the launch links of a text open, as paths in the repository."""
    queries = [
        parse_qs(urlsplit(link).query) for link in re.findall(r"\]\((https://[^)]+)\)", text)
    ]
    pages = [
        (query["urlpath"][0].split("/", 2)[2], "repo" in query)
        for query in queries
        if "urlpath" in query
    ]
    return [page.partition("/")[2] if in_folder else page for page, in_folder in pages]


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Path]:
    """Copies of the files into which links are written."""
    copies = {}
    for name in ("README", "PROJECT", "CITATION"):
        original = getattr(links, name)
        copies[name] = tmp_path / original.name
        copies[name].write_text(original.read_text(encoding="utf-8"), encoding="utf-8")
        monkeypatch.setattr(links, name, copies[name])
    return copies


def test_links_are_written_into_the_readme_and_lead_to_files(written: dict[str, Path]) -> None:
    assert links.main([ADDRESS, "--write"]) == 0
    readme = written["README"].read_text(encoding="utf-8")
    before, _, rest = readme.partition(links.FIRST)
    made, _, after = rest.partition(links.LAST)
    kept = README.read_text(encoding="utf-8")
    assert kept.startswith(before + links.FIRST)
    assert kept.endswith(links.LAST + after)
    assert "https://mybinder.org/v2/gh/someone/ikteach/HEAD?urlpath=lab%2Ftree%2F" in made
    pages = opened(made)
    assert len(pages) == 1 + len(links.chapters()) + len(links.lecture())
    assert {f"notebooks/{file.name}" for file in (ROOT / "notebooks").glob("*.ipynb")} < set(pages)
    for page in pages + opened(kept):
        assert (ROOT / page).is_file(), page
    first = {name: path.read_text(encoding="utf-8") for name, path in written.items()}
    assert links.main([ADDRESS, "--write"]) == 0
    assert {name: path.read_text(encoding="utf-8") for name, path in written.items()} == first


def test_the_address_is_written_where_an_index_and_a_citation_look(
    written: dict[str, Path],
) -> None:
    assert links.main([f"{ADDRESS}.git", "--write"]) == 0
    project = tomllib.loads(written["PROJECT"].read_text(encoding="utf-8"))["project"]
    assert project["urls"]["Homepage"] == ADDRESS
    assert project["urls"]["Issues"] == f"{ADDRESS}/issues"
    for page in project["urls"].values():
        _, _, file = page.partition("/blob/HEAD/")
        assert not file or (ROOT / file).is_file()
    assert f'repository-code: "{ADDRESS}.git"\n' in written["CITATION"].read_text("utf-8")
    assert ADDRESS not in (ROOT / "pyproject.toml").read_text("utf-8")


def test_a_hub_s_links_fetch_the_repository_and_open_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert links.main([f"{ADDRESS}.git", "--hub", f"{HUB}/"]) == 0
    _, _, made = capsys.readouterr().out.partition("hub.example.edu**")
    found = [urlsplit(link) for link in re.findall(r"\(([^)]+)\)", made)]
    assert len(found) == 1 + len(links.chapters()) + len(links.lecture())
    for link in found:
        assert (link.scheme, link.netloc) == ("https", "hub.example.edu")
        assert link.path == "/hub/user-redirect/git-pull"
        assert parse_qs(link.query)["repo"] == [f"{ADDRESS}.git"]
        assert parse_qs(link.query)["urlpath"][0].split("/")[2] == "ikteach"
    for page in opened(made):
        assert (ROOT / page).is_file(), page


@pytest.mark.parametrize(
    ("address", "source"),
    [
        ("https://gitlab.com/a/group/name.git", "gl/a%2Fgroup%2Fname"),
        ("https://git.example.edu/a/name", "git/https%3A%2F%2Fgit.example.edu%2Fa%2Fname"),
    ],
)
def test_other_hosts(address: str, source: str) -> None:
    assert links.on_binder(address, "x/y/z").startswith(f"https://mybinder.org/v2/{source}/HEAD?")


@pytest.mark.parametrize(
    ("argv", "culprit"),
    [
        (["someone/ikteach"], "'someone/ikteach'"),
        (["https://github.com/someone"], "'https://github.com/someone'"),
        ([ADDRESS, "--hub", "http://hub.example.edu"], "'http://hub.example.edu'"),
    ],
)
def test_a_wrong_address_is_named(
    argv: list[str], culprit: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert links.main(argv) == 1
    said = capsys.readouterr().err
    assert said.startswith(culprit)
    assert said.count("\n") == 1


def test_a_readme_without_marks_is_left_alone(
    written: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    readme = written["README"]
    readme.write_text("Mine.\n", encoding="utf-8")
    assert links.main([ADDRESS, "--write"]) == 1
    assert "marks" in capsys.readouterr().err
    assert readme.read_text(encoding="utf-8") == "Mine.\n"
