"""Modes in motion: points move as the configuration of the derivation says, written down here once more."""

import base64
import io
import re
import subprocess

import matplotlib
import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image
from scipy.spatial.transform import Rotation

import proprotor as pp
from proprotor import plots
from proprotor.plots.animation import animate_mode
from proprotor.plots.mode_motion import WingSketch, mode_motion, sketch_of
from proprotor.plots.mode_shape import title_of

matplotlib.use("Agg")
from matplotlib import pyplot as plt

SPEED = "350 kt"


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def sweep(case):
    return case.sweep(SPEED).isel(airspeed=0)


@pytest.fixture(scope="module", params=["chord", "torsion", "regressive lag"])
def motion(case, request):
    return mode_motion(case, SPEED, request.param)


@pytest.fixture(autouse=True)
def close_figures():
    yield
    plt.close("all")


def part(motion, name):
    return next(part for part in motion.parts if part.name == name)


def tip(case, trim, azimuth, q, hub):
    """The tip of the blade at an azimuth: the full position, with finite rotations."""
    rotor, r = case.rotor, case.rotor.radius

    def angle(stem):
        return (
            q.get(f"{stem}_0", 0)
            + q.get(f"{stem}_1c", 0) * np.cos(azimuth)
            + q.get(f"{stem}_1s", 0) * np.sin(azimuth)
        )

    psi = azimuth + q.get("azimuth", 0)
    i, j, k = (
        np.array([np.sin(psi), -np.cos(psi), 0]),
        np.array([np.cos(psi), np.sin(psi), 0]),
        np.array([0, 0, 1]),
    )
    flap, lag = float(trim.coning) + angle("flap"), float(trim.lag) + angle("lag")
    inner, outer = (np.cos(b) * j + np.sin(b) * k for b in (rotor.precone, rotor.precone + flap))
    arm_b, arm_z = r - rotor.flap_hinge_offset, r - rotor.lag_hinge_offset
    own = (r - arm_b) * inner + arm_b * outer + arm_z * ((np.cos(lag) - 1) * outer + np.sin(lag) * i)
    yoke = Rotation.from_rotvec([q.get("gimbal_1s", 0), -q.get("gimbal_1c", 0), 0])
    return hub[:3] + Rotation.from_rotvec(hub[3:]).apply(yoke.apply(own))


def test_tips_move_as_the_configuration_says(case, sweep, motion):
    shape = sweep["shape"].sel(mode=motion.mode)
    model = case.linearize(sweep.airspeed.item())
    path = part(motion, "tip path")
    azimuths = np.linspace(0, 2 * np.pi, len(path.points))
    step = 1e-6
    expected = np.zeros((len(azimuths), 3), dtype=complex)
    for turn in (1, 1j):  # real and imaginary part of the mode
        q = {
            name: float((value * turn.conjugate()).real)
            for name, value in zip(model.dofs, shape.values, strict=True)
        }
        hub = (model.hub @ shape.values * np.conj(turn)).real
        for place, azimuth in enumerate(azimuths):
            ends = [
                tip(case, model.trim, azimuth, {n: s * v for n, v in q.items()}, s * hub)
                for s in (-step, step)
            ]
            expected[place] += turn * (ends[1] - ends[0]) / (2 * step)
    scale = np.vdot(expected, path.motion) / np.vdot(expected, expected)
    assert scale.imag == pytest.approx(0, abs=1e-9 * abs(scale)) and scale.real > 0
    np.testing.assert_allclose(path.motion, scale.real * expected, atol=1e-7 * np.abs(path.motion).max())
    still = [tip(case, model.trim, azimuth, {}, np.zeros(6)) for azimuth in azimuths]
    np.testing.assert_allclose(path.points, still, atol=1e-12)


def test_the_tip_path_is_closed_and_blades_end_on_it(motion):
    path = part(motion, "tip path")
    np.testing.assert_allclose(path.motion[0], path.motion[-1], atol=1e-12)
    per_blade = (len(path.points) - 1) // 3
    for number in range(3):
        blade = part(motion, f"blade {number + 1}")
        leading, trailing = len(blade.points) // 2 - 1, len(blade.points) // 2
        for own, tips in ((blade.points, path.points), (blade.motion, path.motion)):
            np.testing.assert_allclose(
                0.75 * own[leading] + 0.25 * own[trailing], tips[number * per_blade], atol=1e-9
            )


def test_wing_and_mast_hang_together_and_the_root_stands_still(case, motion):
    wing, mast = part(motion, "wing"), part(motion, "mast")
    assert np.abs(wing.motion[[0, -1]]).max() == 0
    foot = wing.points[len(wing.points) // 2 - 1 : len(wing.points) // 2 + 1]
    np.testing.assert_allclose(foot[:, :2], mast.points[[1, 1], :2], atol=1e-12)
    # the elastic axis lies 0.4 of the chord behind the leading edge
    tips = wing.motion[len(wing.points) // 2 - 1 : len(wing.points) // 2 + 1]
    np.testing.assert_allclose(0.6 * tips[0] + 0.4 * tips[1], mast.motion[1], atol=1e-9)


def test_motions_are_scaled_to_be_seen(motion):
    largest = max(np.linalg.norm(np.abs(part.motion), axis=1).max() for part in motion.parts)
    assert largest / motion.radius <= 0.22 + 1e-12
    a, b = motion.at(0.3), motion.at(0.3 + 2 * np.pi)
    assert all(np.allclose(a[name], b[name]) for name in a)
    middle = {name: (points + motion.at(0.3 + np.pi)[name]) / 2 for name, points in a.items()}
    assert all(np.allclose(middle[part.name], part.points) for part in motion.parts)


def test_the_title_has_the_numbers_of_the_sweep(case, sweep):
    motion = mode_motion(case, SPEED, "chord")
    chosen = sweep.sel(mode="chord")
    hertz = float(chosen.frequency) / (2 * np.pi)
    assert f"chord at 350 KTAS: {hertz:.2f} Hz" in title_of(motion)
    assert f"damping {100 * float(chosen.damping_ratio):.2f} %" in title_of(motion)


def test_a_wing_is_as_the_deck_says_where_it_does():
    wing = pp.load_case("xv15-wing")
    assert sketch_of(wing).span == pytest.approx(165 * 0.0254)
    assert sketch_of(wing).mast == pytest.approx(47.3 * 0.0254)
    assert not sketch_of(wing).assumed
    assert sketch_of(pp.load_case("xv15-uncoupled")).assumed


def test_what_cannot_be_shown_is_refused(case):
    with pytest.raises(pp.InputError, match="did you mean chord"):
        mode_motion(case, SPEED, "cord")
    with pytest.raises(pp.InputError, match="oscillate"):
        mode_motion(case, SPEED, "rotor speed")
    with pytest.raises(pp.InputError, match="one speed"):
        mode_motion(case, "100:200:50kt", "chord")
    with pytest.raises(pp.InputError, match="airspeed"):
        mode_motion(case, "0 kt", "chord")


@pytest.mark.parametrize("view", ["front", "side", "top", "3d"])
def test_a_shape_is_drawn_over_the_trim_state_in_radii(case, view):
    motion = mode_motion(case, SPEED, "chord", wing=WingSketch(5.0, 1.3, 1.6))
    figure = plt.figure()
    ax = figure.add_subplot(projection="3d" if view == "3d" else None)
    assert plots.plot_mode_shape(motion, ax, view=view, phase=1.0) is ax
    still, moving = ax.lines[: len(motion.parts)], ax.lines[len(motion.parts) :]
    assert len(moving) == len(motion.parts)
    if view == "front":
        for line, part_ in zip(still, motion.parts, strict=True):
            np.testing.assert_allclose(line.get_xydata(), part_.points[:, [1, 0]] * (-1, 1) / motion.radius)
        points = list(motion.at(1.0).values())[-1]
        np.testing.assert_allclose(moving[-1].get_xydata(), points[:, [1, 0]] * (-1, 1) / motion.radius)
    if view != "3d":
        assert "radii" in ax.get_xlabel() and ax.get_aspect() == 1
    figure.draw_without_rendering()
    with pytest.raises(pp.InputError, match="projection"):
        plots.plot_mode_shape(motion, ax, view="front" if view == "3d" else "3d")


def test_an_unknown_view_is_refused(case):
    with pytest.raises(pp.InputError, match="did you mean side"):
        plots.plot_mode_shape(mode_motion(case, SPEED, "chord"), view="sid")


def test_an_animation_is_a_gif_of_one_cycle_that_repeats(case, tmp_path):
    motion = mode_motion(case, SPEED, "torsion")
    path = animate_mode(motion, tmp_path / "torsion.gif", frames=6, dpi=50)
    with Image.open(path) as picture:
        assert (picture.format, picture.n_frames, picture.info["loop"]) == ("GIF", 6, 0)
        assert picture.size == (400, 220)
        frames = []
        for number in range(6):
            picture.seek(number)
            frames.append(np.asarray(picture.convert("L"), dtype=float))
    changes = [
        np.abs(after - before).mean() for before, after in zip(frames, frames[1:] + frames[:1], strict=True)
    ]
    assert min(changes) > 0.5
    title = [frame[:26] for frame in frames]
    assert all(np.abs(other - title[0]).max() < 40 for other in title)  # what stands still does
    assert not plt.get_fignums()


def pictures_of_page(path):
    """Return the pictures within a page, in their order."""
    encoded = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", path.read_text(encoding="utf-8"))
    return [Image.open(io.BytesIO(base64.b64decode(one))).convert("L") for one in encoded]


@pytest.mark.parametrize("mode", ["beam", "chord", "torsion"])
def test_nothing_that_moves_passes_over_the_small_print(case, tmp_path, mode):
    """In no picture do the lowest rows, of two lines of text, have a pixel of any colour but grey."""
    animate_mode(mode_motion(case, SPEED, mode), tmp_path / "mode.gif", frames=8)
    with Image.open(tmp_path / "mode.gif") as film:
        for frame in range(film.n_frames):
            film.seek(frame)
            rows = np.asarray(film.convert("RGB"))[-30:].astype(int)
            assert rows.min() < 150 and np.ptp(rows, axis=-1).max() < 40


def test_a_page_has_the_pictures_of_the_cycle_and_nothing_from_elsewhere(case, tmp_path):
    motion = mode_motion(case, SPEED, "torsion")
    page = animate_mode(motion, tmp_path / "torsion.html", frames=6, dpi=50)
    gif = animate_mode(motion, tmp_path / "torsion.gif", frames=6, dpi=50)
    pictures = pictures_of_page(page)
    assert len(pictures) == 6
    with Image.open(gif) as moving:
        for place, picture in enumerate(pictures):
            moving.seek(place)
            difference = np.asarray(picture, dtype=float) - np.asarray(moving.convert("L"), dtype=float)
            assert np.abs(difference).mean() < 6  # of 255: both have few colours
    text = page.read_text(encoding="utf-8")
    assert "http" not in text and 'max="5"' in text and "83)" in text  # 12 pictures a second
    assert f"<title>{motion.case}: torsion at " in text


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="needs the program ffmpeg")
def test_a_film_has_whole_cycles(case, tmp_path):
    path = animate_mode(mode_motion(case, SPEED, "torsion"), tmp_path / "torsion.mp4", frames=6, dpi=50)
    raw = ["-f", "rawvideo", "-pix_fmt", "gray", "-"]
    read = subprocess.run([FFMpegWriter.bin_path(), "-i", str(path), *raw], capture_output=True)
    about = read.stderr.decode().partition("Output")[0]
    assert "h264" in about and "yuv420p" in about and "400x220" in about and "12 fps" in about
    film = np.frombuffer(read.stdout, np.uint8).astype(float).reshape(-1, 220, 400)
    assert len(film) % 6 == 0 and 7 <= len(film) / 12 <= 9
    again, later = (np.abs(film[1] - film[place]).mean() for place in (7, 4))
    assert again < 0.2 * later and later > 0.5
    assert [one.name for one in tmp_path.iterdir()] == ["torsion.mp4"] and not plt.get_fignums()


def test_a_film_without_ffmpeg_is_refused_in_one_line(case, tmp_path):
    motion, missing = mode_motion(case, SPEED, "torsion"), {"animation.ffmpeg_path": "no-such-program"}
    with (
        matplotlib.rc_context(missing),
        pytest.raises(pp.InputError, match="needs the program ffmpeg") as caught,
    ):
        animate_mode(motion, tmp_path / "torsion.mp4")
    assert "\n" not in str(caught.value) and not list(tmp_path.iterdir())


def test_an_animation_that_cannot_be_made_is_refused(case, tmp_path):
    motion = mode_motion(case, SPEED, "chord")
    with pytest.raises(pp.InputError, match=r"gif, \.html, \.mp4"):
        animate_mode(motion, tmp_path / "chord.avi")
    with pytest.raises(pp.InputError, match="at least 4"):
        animate_mode(motion, tmp_path / "chord.gif", frames=2)
    assert not list(tmp_path.iterdir())
