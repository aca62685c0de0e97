"""The explorer in a notebook, here an event loop: shown to who knows its address, and to nobody else."""

import asyncio
import re
from contextlib import asynccontextmanager

import numpy as np
import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest

import proprotor as pp

KT = 1852 / 3600
DEG = np.pi / 180
FRAME = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Dest": "iframe"}


@asynccontextmanager
async def shown(case, *arguments, **more):
    """The page of a case, until it is not needed any more."""
    found = pp.explore(case, *arguments, **more)
    try:
        yield found
    finally:
        found.stop()


async def status(address, **headers):
    request = HTTPRequest(address, headers=headers, request_timeout=60)
    return (await AsyncHTTPClient().fetch(request, raise_error=False)).code


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


def test_a_foreign_page_may_show_the_secret_place_alone(case):
    async def asked():
        async with shown(case) as page:
            root, _, secret = page.address.rpartition("/")
            assert root.startswith("http://127.0.0.1:") and len(secret) >= 32
            assert await status(page.address, **FRAME) == 200
            assert await status(page.address) == 200
            for place in ("/", f"/{secret[:-1]}", f"/{secret}x", "/static/js/bokeh.min.js", f"/{secret}/ws"):
                assert await status(root + place, **FRAME) == 403, place
            element = f"/{secret}/autoload.js?bokeh-autoload-element=x"
            assert await status(root + element) == 403
            assert await status(page.address, Host="evil.example") == 403
            assert await status(page.address, Origin="http://evil.example") == 403

    asyncio.run(asked())


def test_each_page_has_a_place_of_its_own(case):
    async def both():
        async with shown(case) as one, shown(case) as other:
            return one.address, other.address

    one, other = asyncio.run(both())
    assert one.rpartition("/")[2] != other.rpartition("/")[2]


def test_the_cell_shows_a_frame_and_the_case_comes_back(case):
    async def asked():
        async with shown(case.vary({"rotor.precone": 1.5 * DEG}), "300:400:20kt", pitch="coupling") as page:
            frame = page._repr_html_()
            assert re.search(r'<iframe src="([^"]+)" title="[^"]+"', frame)[1] == page.address
            assert page.case.rotor.precone == pytest.approx(1.5 * DEG)
            assert await status(page.address) == 200
            opened = page._shown
            assert "precone 1.5 deg (deck 2.5)" in opened.readout.text
            assert len(opened.chosen.airspeeds) == 6 and page.options["pitch"] == "coupling"
            opened.chosen.values["rotor.precone"] = 3 * DEG
            assert page.case.rotor.precone == pytest.approx(3 * DEG)

    asyncio.run(asked())


def test_what_was_varied_comes_along_though_the_deck_leaves_it_out(case):
    varied = case.vary({"rotor.kinematic_pitch_flap_coupling": "10 deg", "rotor.precone": "3 deg"})

    async def asked():
        async with shown(varied, "300:400:20kt") as page:
            assert await status(page.address) == 200
            return page._shown.chosen.values, page.case

    values, found = asyncio.run(asked())
    assert values == {
        "rotor.kinematic_pitch_flap_coupling": pytest.approx(np.tan(10 * DEG)),
        "rotor.precone": pytest.approx(3 * DEG),
    }
    assert found.rotor.kinematic_pitch_flap_coupling == pytest.approx(np.tan(10 * DEG))


def test_control_loops_that_no_deck_has_are_not_left_out_in_silence(case):
    loop = pp.ControlLoop(name="hold", sensors="x rate", inputs="cyclic_1c", gain=-1e-3)

    async def asked():
        with pytest.raises(pp.InputError, match="control loops in the deck"):
            pp.explore(case.with_control(loop))

    asyncio.run(asked())


def test_outside_a_notebook_the_message_names_the_command(case):
    with pytest.raises(pp.InputError, match=r"needs a notebook.*proprotor explore"):
        pp.explore(case)


@pytest.mark.parametrize(
    ("arguments", "options", "told"),
    [
        (("300 kt",), {}, "must be a range"),
        (("300:400:20 kg",), {}, "airspeed"),
        ((), {"pitch": "stiff"}, "pitch"),
        ((), {"pich": "rigid"}, "pich"),
    ],
)
def test_what_cannot_be_is_one_message(case, arguments, options, told):
    async def asked():
        with pytest.raises(pp.InputError, match=told):
            pp.explore(case, *arguments, **options)

    asyncio.run(asked())
