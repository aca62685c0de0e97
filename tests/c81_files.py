"""Writing C81 files, for tests. Every table here is made up: none is that of a real airfoil."""

import numpy as np


def as_c81(title: str, **tables) -> str:
    """The text of a C81 file with tables (angles in deg, Mach numbers, values) of lift, drag and moment.

    Numbers fill their seven columns: nothing but the columns separates them.
    """
    tables = [tables[name] for name in ("lift", "drag", "moment")]
    counts = "".join(f"{len(mach):2d}{len(alpha):2d}" for alpha, mach, _ in tables)
    lines = [f"{title:30.30}{counts}"]
    for alpha, mach, values in tables:
        lines += rows(" " * 7, mach)
        for angle, row in zip(alpha, values, strict=True):
            lines += rows(f"{angle:7.2f}", row)
    return "\n".join(lines) + "\n"


def rows(start: str, numbers) -> list[str]:
    lines = [numbers[i : i + 9] for i in range(0, len(numbers), 9)]
    begins = [start] + [" " * 7] * (len(lines) - 1)
    return [begin + "".join(f"{x:7.4f}" for x in line) for begin, line in zip(begins, lines, strict=True)]


def made_up_tables(n_mach: int = 11) -> dict:
    """Stall, a drag rise and all around the circle; each coefficient on its own grid; four digits."""
    mach = np.round(np.linspace(0, 0.9, n_mach), 4)
    lift_alpha = np.array([-180, -170, -90, -30, *range(-16, 18, 2), 30, 90, 170, 180.0])
    drag_alpha = np.array([-180, -90, -20, -10, -5, -2, 0, 2, 5, 10, 20, 90, 180.0])
    moment_alpha = np.array([-20, -10, -3, 0, 4, 9, 15, 25.0])
    a = np.deg2rad(lift_alpha)[:, None]
    slope = 5.9 / np.sqrt(1 - mach**2)
    attached = np.abs(lift_alpha[:, None]) < 17
    stalled = 1.1 * np.sin(2 * a)
    lift = np.where(attached, np.clip(slope * (a + 0.02), -0.9 + 0.2 * mach, 1.2 - 0.4 * mach), stalled)
    d = np.deg2rad(drag_alpha)[:, None]
    drag = 0.007 + 1.8 * np.sin(d) ** 2 + 0.4 * np.maximum(mach - 0.7, 0) ** 2 * np.ones_like(d)
    few = mach[::4]
    moment = -0.03 / np.sqrt(1 - few**2) + 0.1 * np.deg2rad(moment_alpha)[:, None] ** 3
    return {
        "lift": (lift_alpha, mach, np.round(lift, 4)),
        "drag": (drag_alpha, mach, np.round(drag, 4)),
        "moment": (moment_alpha, few, np.round(moment, 4)),
    }
