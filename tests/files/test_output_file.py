"""Files appear whole, whoever else writes them, whatever they are called, with the permissions they had.

`test_faults` fills the disk and kills programs; here many write at once, and every writer of the package is shown to go
through the one function that does it right.
"""

import ast
import os
import stat
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.io import loadmat

import proprotor as pp
from proprotor.commands.main import main
from proprotor.errors import InputError
from proprotor.exchange.matlab import save_matlab
from proprotor.files.output import check_writable, write_whole
from proprotor.plots.animation import animate_mode
from proprotor.plots.mode_motion import mode_motion

SOURCE = Path(pp.__file__).parent
LONG = "n" * 246


def content(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def write(path, text=b"after"):
    write_whole(path, lambda file: file.write(text))


def mode_of(path):
    return stat.S_IMODE(path.stat().st_mode)


# Many at once -------------------------------------------------------------------------------------


def test_threads_on_one_file_all_succeed_and_readers_see_whole_ones(tmp_path):
    path, texts = tmp_path / "one.csv", [bytes([place]) * 100_000 for place in range(8)]
    write(path, texts[0])
    seen, stop = set(), threading.Event()

    def read():
        while not stop.is_set():
            seen.add(path.read_bytes())

    reader = threading.Thread(target=read)
    reader.start()
    try:
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(lambda text: [write(path, text) for _ in range(20)], texts))
    finally:
        stop.set()
        reader.join()
    assert len(seen) > 1 and seen <= set(texts)
    assert path.read_bytes() in texts
    assert list(content(tmp_path)) == ["one.csv"]


WRITES = """
import sys
from proprotor.files.output import write_whole
sys.stdin.read()
for _ in range(50):
    write_whole(sys.argv[1], lambda file: file.write(sys.argv[2].encode() * 10_000))
"""


def test_processes_on_one_file_all_succeed(tmp_path):
    path = tmp_path / "one.csv"
    command = [sys.executable, "-c", WRITES, path]
    writers = [subprocess.Popen([*command, letter], stdin=subprocess.PIPE) for letter in "abcd"]
    for writer in writers:
        writer.stdin.close()
    assert [writer.wait() for writer in writers] == [0] * 4
    assert path.read_bytes() in [letter.encode() * 10_000 for letter in "abcd"]
    assert list(content(tmp_path)) == ["one.csv"]


SAVES = """
import sys
from concurrent.futures import ThreadPoolExecutor
import numpy as np
import xarray as xr
import proprotor as pp

def results(number):
    values = np.full((40, 50), complex(number, -number))
    return xr.Dataset({"eigenvalue": (("design", "state"), values), "note": ("design", np.full(40, str(number)))})

def save(number):
    name = f"{sys.argv[1]}/{number if sys.argv[2] == 'own' else 'one'}.nc"
    pp.save_results(results(number), name)
    found = pp.load_results(name)
    kept = int(found.note.values[0])
    xr.testing.assert_identical(found, results(kept))
    return kept

with ThreadPoolExecutor(8) as pool:
    kept = list(pool.map(save, range(64)))
assert sys.argv[2] != "own" or kept == list(range(64))
print("saved")
"""


@pytest.mark.parametrize("files", ["own", "one"])
def test_results_are_saved_and_loaded_by_many_threads(tmp_path, files):
    """In a process of its own: netCDF used by two threads at once ends the whole process."""
    command = [sys.executable, "-c", SAVES, tmp_path, files]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "saved\n", "")
    assert all(name.endswith(".nc") for name in content(tmp_path))


# Names and what is there before -------------------------------------------------------------------


def test_a_leftover_of_the_same_process_is_in_nobodys_way(tmp_path):
    path = tmp_path / "modes.csv"
    leftovers = [f".modes.csv.{os.getpid()}.tmp", ".proprotor-0123456789abcdef.tmp", ".tmp"]
    for name in leftovers:
        (tmp_path / name).write_bytes(b"old")
    write(path)
    assert content(tmp_path) == dict.fromkeys(leftovers, b"old") | {"modes.csv": b"after"}


def test_a_name_of_another_is_never_taken_over(tmp_path, monkeypatch):
    """Even if chance gave the name of a file that is there, it would be left alone."""
    monkeypatch.setattr("secrets.token_hex", lambda size: "same")
    (tmp_path / ".proprotor-same.tmp").write_bytes(b"of another")
    with pytest.raises(FileExistsError):
        write(tmp_path / "modes.csv")
    assert content(tmp_path) == {".proprotor-same.tmp": b"of another"}


@pytest.mark.parametrize("length", [250, 255])
def test_a_long_name(tmp_path, length):
    path = tmp_path / ("n" * (length - 4) + ".csv")
    check_writable(path)
    write(path)
    assert content(tmp_path) == {path.name: b"after"}


def test_a_name_too_long_is_told_before(tmp_path):
    for told in (check_writable, write):
        with pytest.raises(OSError, match="File name too long"):
            told(tmp_path / ("n" * 256))
    assert content(tmp_path) == {}


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o644, 0o660, 0o755, 0o4700])
def test_permissions_stay(tmp_path, mode):
    path = tmp_path / "modes.csv"
    path.write_bytes(b"before")
    path.chmod(mode)
    write(path)
    assert mode_of(path) == mode and path.read_bytes() == b"after"


def test_a_private_file_is_never_open_to_others_while_it_is_written(tmp_path):
    path = tmp_path / "modes.csv"
    path.write_bytes(b"before")
    path.chmod(0o600)
    write_whole(
        path, lambda file: modes.append(mode_of(Path(file.name))) if (modes := seen) is seen else None
    )
    assert seen == [0o600]


seen: list[int] = []


@pytest.mark.parametrize("umask", [0o022, 0o077, 0o002])
def test_a_new_file_has_what_the_umask_leaves(tmp_path, umask):
    before = os.umask(umask)
    try:
        write(tmp_path / "modes.csv")
    finally:
        os.umask(before)
    assert mode_of(tmp_path / "modes.csv") == 0o666 & ~umask


def test_links(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "file").write_bytes(b"before")
    (tmp_path / "folder" / "file").chmod(0o600)
    (tmp_path / "first").symlink_to("second")
    (tmp_path / "second").symlink_to("folder/file")
    write(tmp_path / "first")
    assert (tmp_path / "first").is_symlink() and (tmp_path / "second").is_symlink()
    assert content(tmp_path / "folder") == {"file": b"after"}
    assert mode_of(tmp_path / "folder" / "file") == 0o600
    (tmp_path / "nowhere").symlink_to("folder/new")
    write(tmp_path / "nowhere")
    assert (tmp_path / "nowhere").is_symlink()
    assert (tmp_path / "folder" / "new").read_bytes() == b"after"
    (tmp_path / "round").symlink_to("round")
    for told in (check_writable, write):
        with pytest.raises(OSError, match="symbolic links"):
            told(tmp_path / "round")
    (tmp_path / "to-folder").symlink_to("folder")
    for told in (check_writable, write):
        with pytest.raises(InputError, match="must be a file"):
            told(tmp_path / "to-folder")


READ_ONLY = """
import os, sys
from proprotor.files.output import check_writable, write_whole
if os.getuid() == 0:
    os.setuid(65534)  # permissions do not hold the superuser
for told in (check_writable, lambda path: write_whole(path, lambda file: file.write(b"after"))):
    for path in ("folder/new", "file"):
        try:
            told(f"{sys.argv[1]}/{path}")
        except PermissionError as error:
            print(error.strerror)
"""


def test_what_may_not_be_written_is_told_before():
    with tempfile.TemporaryDirectory() as name:  # where another user reaches it
        folder = Path(name)
        folder.chmod(0o777)
        (folder / "folder").mkdir(mode=0o555)
        (folder / "file").write_bytes(b"before")
        (folder / "file").chmod(0o444)
        # Without coverage, whose data another user may not write.
        env = {key: value for key, value in os.environ.items() if not key.startswith("COV")}
        command = [sys.executable, "-c", READ_ONLY, name]
        done = subprocess.run(command, env=env, capture_output=True, text=True)
        assert (done.stdout, done.stderr) == ("Permission denied\n" * 4, "")
        assert content(folder) == {"file": b"before"}


# Failures -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", ["fsync", "chmod", "replace", "write"])
@pytest.mark.parametrize("error", [OSError(5, "Input/output error"), KeyboardInterrupt()])
def test_whatever_fails_what_was_there_stays_and_nothing_else(tmp_path, monkeypatch, step, error):
    path = tmp_path / "modes.csv"
    path.write_bytes(b"before")
    path.chmod(0o755)

    def fails(*_):
        raise error

    if step != "write":
        monkeypatch.setattr(f"proprotor.files.output.os.{step}", fails)
    with pytest.raises(type(error)):
        write_whole(path, fails if step == "write" else lambda file: file.write(b"after"))
    monkeypatch.undo()
    assert content(tmp_path) == {"modes.csv": b"before"}
    assert mode_of(path) == 0o755


def test_what_is_written_is_on_the_disk_before_it_takes_its_place(tmp_path, monkeypatch):
    done = []
    for step in ("fsync", "replace"):
        own = getattr(os, step)
        monkeypatch.setattr(
            f"proprotor.files.output.os.{step}", lambda *a, own=own, step=step: (done.append(step), own(*a))
        )
    write(tmp_path / "modes.csv")
    assert done == ["fsync", "replace"]


# Every writer -------------------------------------------------------------------------------------

CASE = pp.load_case("xv15-uncoupled")


def command(*arguments):
    done = CliRunner().invoke(main, [str(argument) for argument in arguments])
    if done.exit_code:
        raise OSError(done.stderr)


SWEEP = ("sweep", "xv15-uncoupled", "--speed", "100:200:50kt")
MAP = ("map", "xv15-uncoupled", "--x", "airspeed=200:260:30kt", "--y", "rotor.precone=1:2:1 deg")
WRITERS = {
    "sweep.csv": lambda path: command(*SWEEP, "--csv", path),
    "sweep.png": lambda path: command(*SWEEP, "--plot", path),
    "sweep.svg": lambda path: command(*SWEEP, "--plot", path),
    "flutter.csv": lambda path: command("flutter", "xv15-uncoupled", "--scan", "200:240:20kt", "--csv", path),
    "map.csv": lambda path: command(*MAP, "--csv", path),
    "map.pdf": lambda path: command(*MAP, "--plot", path),
    "study.nc": lambda path: command(
        "study", "xv15-uncoupled", "--speed", "200 kt", "--vary", "rotor.precone=1:2:1 deg", "--out", path
    ),
    "report.html": lambda path: command("report", "xv15-uncoupled", "--speed", "200:220:20kt", "--out", path),
    "report.pdf": lambda path: command("report", "xv15-uncoupled", "--speed", "200:220:20kt", "--out", path),
    "deck.toml": lambda path: command("new", path, "--force"),
    "sweep.nc": lambda path: pp.save_results(CASE.sweep([80.0, 90.0]), path),
    "model.mat": lambda path: save_matlab(CASE.linearize(100.0), path),
    "mode.gif": lambda path: animate_mode(mode_motion(CASE, "80 m/s", "chord"), path, frames=4, dpi=20),
}


@pytest.mark.parametrize("name", WRITERS)
def test_every_writer_writes_whole_files(tmp_path, monkeypatch, name):
    """A file of the longest name, private before: replaced and private after; as it was where moving it fails."""
    ending = Path(name).suffix
    path = tmp_path / f"{LONG[: 255 - len(ending)]}{ending}"
    path.write_bytes(b"before")
    path.chmod(0o600)
    WRITERS[name](path)
    written = content(tmp_path)
    assert list(written) == [path.name] and len(written[path.name]) > 100
    assert mode_of(path) == 0o600

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("proprotor.files.output.os.replace", full)
    with pytest.raises(OSError, match="No space left on device"):
        WRITERS[name](path)
    assert content(tmp_path) == written


def test_what_is_written_can_be_read(tmp_path):
    """With readers that are not this package's."""
    import netCDF4

    sweep, model = CASE.sweep([80.0, 90.0]), CASE.linearize(100.0)
    pp.save_results(sweep, tmp_path / "sweep.nc")
    with netCDF4.Dataset(tmp_path / "sweep.nc") as stored:
        assert stored.data_model == "NETCDF4"
        parts = [np.asarray(stored[f"eigenvalue_{part}"][:]) for part in ("real", "imag")]
    np.testing.assert_array_equal(parts[0], sweep.eigenvalue.values.real)
    np.testing.assert_array_equal(parts[1], sweep.eigenvalue.values.imag)
    save_matlab(model, tmp_path / "model.mat")
    np.testing.assert_array_equal(loadmat(tmp_path / "model.mat")["K"], model.K)


def _writes(call):
    """Whether a call opens or moves a file for writing by itself."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    owner = getattr(getattr(call.func, "value", None), "id", "")
    if name in ("write_text", "write_bytes", "to_csv", "to_json", "savetxt", "mkstemp", "NamedTemporaryFile"):
        return True
    if name in ("replace", "rename", "link", "symlink") and owner == "os":
        return True
    if name in ("savefig", "savemat", "to_netcdf", "savez", "save") and call.args:
        target = ast.unparse(call.args[0])
        return target not in (
            "file",
            "path",
            "content",
            "number",
        )  # of `write_whole`; in memory; a batch
    given = [*call.args, *(keyword.value for keyword in call.keywords)]
    texts = [arg.value for arg in given if isinstance(arg, ast.Constant) and isinstance(arg.value, str)]
    return name == "open" and any(set(text) <= set("rwxabt+") and set(text) & set("wxa+") for text in texts)


def test_nothing_else_in_the_package_opens_a_file_to_write():
    found = [
        f"{path.relative_to(SOURCE)}:{node.lineno}"
        for path in sorted(SOURCE.rglob("*.py"))
        if path != SOURCE / "files" / "output.py"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and _writes(node)
    ]
    assert found == []
