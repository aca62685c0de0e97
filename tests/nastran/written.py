"""Files of Nastran, written from the published layouts: no code of the readers is used here.

Sources: DMAP guides of MSC and Siemens (data blocks LAMA and OUG, modules OUTPUT2 and OUTPUT4), MSC's description of
the HDF5 file (NASTRAN/RESULT), the Quick Reference Guide (DMIG, EXTRN, punched eigenvectors). Labels have the form of
those in public files; the years after 2021 of MSC, and those of Simcenter and Autodesk, are formed alike.
"""

import struct
from dataclasses import dataclass, field

import numpy as np

HUB, OTHER = 1101, 7
# Words of the heading after the tape's name, by program: text, four characters a word.
LABELS = {
    "MSC 2005": ["XXXXXXXX"],
    "MSC 2014": ["XXXXXXXX", "20140   0   \0\0\0\0        "],
    "MSC 2018.2": ["XXXXXXXX20182   0   \0\0\0\0        "],
    "MSC 2019": ["XXXXXXXX20190   0   \0\0\0\0        "],
    "MSC 2020": ["XXXXXXXX20200   0   \0\0\0\0        "],
    "MSC 2021.4": ["XXXXXXXX20214   0   \0\0\0\0        "],
    "MSC 2022.3": ["XXXXXXXX20223   0   \0\0\0\0        "],
    "MSC 2023.2": ["XXXXXXXX20232   0   \0\0\0\0        "],
    "MSC 2024.1": ["XXXXXXXX20241   0   \0\0\0\0        "],
    "MSC 2025.1": ["XXXXXXXX20251   0   \0\0\0\0        "],
    "NX 8.5": ["NX8.5   "],
    "NX 2019.2": ["NX2019.2"],
    "Simcenter 2312": ["NX2312  "],
    "OptiStruct": ["OS12.210"],
    "Autodesk": ["NE 17.0 "],
    "a label nobody knows": ["Q7      "],
}


@dataclass
class Run:
    """Modes of one subcase as Nastran has them: ω² (k,), generalised mass (k,), motion T1 … R3 (6, k) of the hub's grid
    point, and further grid points, in which nothing moves."""

    eigenvalue: np.ndarray
    mass: np.ndarray
    motion: np.ndarray
    subcase: int = 1
    label: str = ""
    points: tuple = (OTHER, HUB)
    first: int = 1  # number of the first mode

    def motion_of(self, point, place):
        """Motion of a grid point in a mode."""
        return self.motion[:, place] if point == HUB else np.zeros(6)


@dataclass
class Op2:
    """An .op2 file: form of its words, heading, and data blocks in their order."""

    order: str = "<"
    width: int = 4
    label: tuple = ("NX8.5   ",)
    post: int = -1
    content: list = field(default_factory=list)

    # Words and records

    def words(self, *values):
        """Words: whole numbers, real numbers, and text of four characters a word."""
        whole, real = ("i", "f") if self.width == 4 else ("q", "d")
        parts = []
        for value in values:
            if isinstance(value, str):
                pieces = [value[start : start + 4] for start in range(0, len(value), 4)]
                parts += [piece.encode("latin-1").ljust(self.width) for piece in pieces]
            else:
                parts.append(struct.pack(self.order + (real if isinstance(value, float) else whole), value))
        return b"".join(parts)

    def record(self, content):
        """A Fortran record."""
        length = struct.pack(f"{self.order}i", len(content))
        return length + content + length

    def marker(self, value):
        return self.record(self.words(value))

    def data(self, content):
        """A marker with the number of words, and the words."""
        return self.marker(len(content) // self.width) + self.record(content)

    # Data blocks

    def heading(self):
        """Date, tape's name and label of the program; PARAM,POST,-2 leaves it out."""
        if self.post == -2:
            return b""
        parts = [self.words(9, 14, 24), self.words("NASTRAN FORT TAPE ID CODE - ")]
        parts += [self.words(text) for text in self.label]
        return b"".join(map(self.data, parts)) + self.marker(-1) + self.marker(0)

    def block(self, name, records, kind=0, version=""):
        """A data block: name, trailer, a heading with its name, and its records."""
        self.content.append(self.data(self.words(name.ljust(8))))
        if version:
            self.content.append(self.data(self.words(version)))
        self.content += [self.marker(-1), self.data(self.words(101, 0, 0, 0, 0, 0, 0))]
        contents = [[self.words(name.ljust(8))], *records]
        for place, pieces in enumerate(contents, start=2):
            self.content += [self.marker(-place), self.data(self.words(kind if place > 2 else 0))]
            self.content += [self.data(piece) for piece in pieces]
        self.content += [self.marker(-len(contents) - 2), self.data(self.words(0)), self.marker(0)]
        return self

    def codes(self, approach, table, subcase, number, eigenvalue, row, label="", second=0.0):
        """The record of 146 words before each record of results."""
        words = [10 * approach + 2, table, 0, subcase, number, eigenvalue, second, 0, 1, row]
        text = "".join(part.ljust(128) for part in ("A WING", label, f"SUBCASE {subcase}"))
        return self.words(*words, *([0] * 40), text)

    def lama(self, run, name="LAMA", approach=2):
        """The table of eigenvalues."""
        rows = []
        for place, (square, mass) in enumerate(zip(run.eigenvalue, run.mass, strict=True)):
            omega = abs(square) ** 0.5
            rows += [run.first + place, place + 1, *map(float, (square, omega, omega / 6.283185307179586))]
            rows += [float(mass), float(mass * square)]
        codes = self.codes(approach, 6, 0, 0, 0, 7)
        return self.block(name, [[codes], [self.words(*rows)]])

    def vectors(self, run, name="OUGV1", approach=2, version="", split=1):
        """Eigenvectors by mode (SORT1), each record in pieces."""
        records = []
        for place, square in enumerate(run.eigenvalue):
            codes = self.codes(approach, 7, run.subcase, run.first + place, float(square), 8, run.label)
            rows = [self.row(point, run.motion_of(point, place)) for point in run.points]
            records += [[codes], _pieces(b"".join(rows), split, self.width)]
        return self.block(name, records, version=version)

    def vectors_by_point(self, run, name="OUGV2"):
        """Eigenvectors by grid point (SORT2), whose rows are modes."""
        records = []
        for point in run.points:
            codes = self.codes(2, 2007, run.subcase, 10 * point + 2, 0.0, 8, run.label)
            rows = [
                self.words(run.first + place, 1, *map(float, run.motion_of(point, place)))
                for place in range(len(run.eigenvalue))
            ]
            records += [[codes], [b"".join(rows)]]
        return self.block(name, records)

    def complex_vectors(self, run, name="OUGV1"):
        """Complex eigenvectors of the same modes."""
        records = []
        for place, square in enumerate(run.eigenvalue):
            codes = self.codes(9, 1007, run.subcase, 1 + place, -0.1, 14, run.label, float(square) ** 0.5)
            rows = [
                self.row(point, np.append(run.motion_of(point, place), np.ones(6))) for point in run.points
            ]
            records += [[codes], [b"".join(rows)]]
        return self.block(name, records)

    def points(self, systems, name="GEOM1", wide=False):
        """Entries GRID by number, with their output coordinate systems; coordinates of double precision if wide."""
        words = self.words(4501, 45, 1120001 if wide else 1)
        for point, system in systems.items():
            place = (
                struct.pack(f"{self.order}3d", 1.0, 2.0, 3.0)
                if wide and self.width == 4
                else self.words(1.0, 2.0, 3.0)
            )
            words += self.words(point, 0) + place + self.words(system, 0, 0)
        return self.block(name, [[self.words(2101, 21, 8)], [words]])

    def other_blocks(self):
        """A matrix in columns, stresses in an unknown layout, and geometry in an old one: nothing that is needed."""
        column = [self.data(self.words(1)), self.record(self.words(1, 1.0, 2.0))]
        self.content += [self.data(self.words("KHH     ")), self.marker(-1), self.data(self.words(*[7] * 7))]
        self.content += [self.marker(-2), self.data(self.words(0)), self.data(self.words("KHH     "))]
        # Of a column of a matrix the marker counts the entries, and the record has the row before them.
        self.content += [self.marker(-3), *column[:1], self.marker(2), column[1], self.marker(-4)]
        self.content += [self.data(self.words(0)), self.marker(0)]
        self.block("OES1X1", [[self.codes(2, 5, 1, 1, 1.0, 99)], [self.words(1, 2, 3.0)]])
        return self.block("GEOM1S", [[self.words(4501, 45, 99)]])

    def row(self, point, motion):
        return self.words(10 * point + 2, 1, *map(float, motion))

    def bytes(self):
        return b"".join([self.heading(), *self.content, self.marker(0)])

    def save(self, path):
        path.write_bytes(self.bytes())
        return path


def _pieces(content, count, width):
    """Cut a record into pieces of whole words."""
    step = max(width, len(content) // count // width * width)
    return [content[start : start + step] for start in range(0, len(content), step)]


# HDF5 ---------------------------------------------------------------------------------------------


def save_hdf5(path, runs, complex_too=False, eigenvalues=True, approach=2, systems=None):
    """An HDF5 file of MSC Nastran, with the group INDEX left out, which no reader needs."""
    import h5py

    names = [
        "ID",
        "SUBCASE",
        "STEP",
        "ANALYSIS",
        "TIME_FREQ_EIGR",
        "EIGI",
        "MODE",
        "DESIGN_CYCLE",
        "RANDOM",
        "SE",
    ]
    names += ["AFPM", "TRMC", "INSTANCE", "MODULE", "SUBSTEP", "IMPFID"]
    real = {"TIME_FREQ_EIGR", "EIGI"}
    domain_type = [(name, "<f8" if name in real else "<i8") for name in names]
    vector_type = [
        ("ID", "<i8"),
        *((name, "<f8") for name in ("X", "Y", "Z", "RX", "RY", "RZ")),
        ("DOMAIN_ID", "<i8"),
    ]
    table_type = [("MODE", "<i8"), ("ORDER", "<i8"), ("EIGEN", "<f8"), ("OMEGA", "<f8"), ("FREQ", "<f8")]
    table_type += [
        ("MASS", "<f8"),
        ("STIFF", "<f8"),
        ("RESFLG", "<i8"),
        ("FLDFLG", "<i8"),
        ("DOMAIN_ID", "<i8"),
    ]
    domains, vectors, table = [], [], []

    def domain(subcase, code, eigenvalue, mode):
        domains.append((len(domains) + 1, subcase, 0, code, eigenvalue, 0.0, mode, *([0] * 9)))
        return len(domains)

    for run in runs:
        for place, (square, mass) in enumerate(zip(run.eigenvalue, run.mass, strict=True)):
            mode, omega = run.first + place, abs(square) ** 0.5
            own = domain(0, 0, 0.0, mode)
            table.append((mode, mode, square, omega, omega / 2 / np.pi, mass, mass * square, 0, 0, own))
    for run in runs:
        for place, square in enumerate(run.eigenvalue):
            own = domain(run.subcase, approach, square, run.first + place)
            vectors += [(point, *run.motion_of(point, place), own) for point in run.points]
    with h5py.File(path, "w") as file:
        file.attrs["SCHEMA"] = [20200]
        file["NASTRAN/RESULT/DOMAINS"] = np.array(domains, dtype=domain_type)
        file["NASTRAN/RESULT/NODAL/EIGENVECTOR"] = np.array(vectors, dtype=vector_type)
        if eigenvalues:
            file["NASTRAN/RESULT/SUMMARY/EIGENVALUE"] = np.array(table, dtype=table_type)
        if systems:
            grid = [
                ("ID", "<i8"),
                ("CP", "<i8"),
                ("X", "<f8", (3,)),
                ("CD", "<i8"),
                ("PS", "<i8"),
                ("SEID", "<i8"),
            ]
            rows = [(point, 0, (1.0, 2.0, 3.0), system, 0, 0) for point, system in systems.items()]
            file["NASTRAN/INPUT/NODE/GRID"] = np.array(rows, dtype=grid)
        if complex_too:
            file["NASTRAN/RESULT/NODAL/EIGENVECTOR_CPLX"] = np.zeros(3)
    return path


# Text ---------------------------------------------------------------------------------------------


def save_punch(path, runs, form="REAL", kind="EIGENVECTOR"):
    """A punch file: 72 columns, and the number of the line in the last eight."""
    lines = []
    for run in runs:
        for place, square in enumerate(run.eigenvalue):
            lines += [
                "$TITLE   = A WING",
                f"$SUBTITLE={run.label}",
                "$LABEL   =",
                f"${kind}",
                f"${form} OUTPUT",
            ]
            lines += [f"$SUBCASE ID ={run.subcase:12d}"]
            lines += [f"$EIGENVALUE ={square:15.7E}  MODE ={run.first + place:6d}"]
            for point in run.points:
                motion = run.motion_of(point, place)
                lines += [f"{point:10d}       G" + "".join(f"{value:18.6E}" for value in motion[:3])]
                lines += ["-CONT-            " + "".join(f"{value:18.6E}" for value in motion[3:])]
    path.write_text(
        "".join(f"{line:72}{place:8d}\n" for place, line in enumerate(lines, 1)), encoding="utf-8"
    )
    return path


def save_printed(path, runs, cycles=True, rows_of_a_page=50):
    """A print file, with an eigenvector on as many pages as it needs."""
    lines = []
    for run in runs:
        lines += [_page(run), "", f"0{'':46}R E A L   E I G E N V A L U E S"]
        lines += [
            "   MODE    EXTRACTION      EIGENVALUE            RADIANS             CYCLES            GENERALIZED"
        ]
        lines += [
            "    NO.       ORDER                                                                       MASS"
        ]
        for place, (square, mass) in enumerate(zip(run.eigenvalue, run.mass, strict=True)):
            omega = abs(square) ** 0.5
            values = (square, omega, omega / 2 / np.pi, mass, mass * square)
            lines += [
                f"{run.first + place:9d}{place + 1:10d}" + "".join(f"{value:20.6E}" for value in values)
            ]
        for place, square in enumerate(run.eigenvalue):
            lines += _printed_vector(run, place, square, cycles, rows_of_a_page)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _page(run):
    return f"1    A WING{'':60}OCTOBER  19, 2025  MSC Nastran 12/12/24   PAGE    13"


def _printed_vector(run, place, square, cycles, rows_of_a_page):
    """An eigenvector; zeros are printed without an exponent."""
    lines = []
    for start in range(0, len(run.points), rows_of_a_page):
        lines += [
            _page(run),
            f"     {run.label}",
            f"0{'':104}SUBCASE {run.subcase}",
            f"      EIGENVALUE = {square:13.6E}",
        ]
        head = f"          CYCLES = {abs(square) ** 0.5 / 2 / np.pi:13.6E}" if cycles else ""
        lines += [f"{head:41}R E A L   E I G E N V E C T O R   N O .{run.first + place:11d}", ""]
        lines += [
            "      POINT ID.   TYPE          T1             T2             T3             R1             R2"
        ]
        for point in run.points[start : start + rows_of_a_page]:
            values = "".join(
                f"{value:15.6E}" if value else "   0.0         " for value in run.motion_of(point, place)
            )
            lines += [f"{point:14d}      G   {values}"]
    return lines


def save_dmig(path, matrices, coordinates, form=6, small=False, before=""):
    """Matrices as entries DMIG; of a symmetric one the lower triangle alone."""
    lines = [before, "$ MATRICES OF AN EXTERNAL SUPERELEMENT"]
    for name, matrix in matrices.items():
        lines.append(f"DMIG    {name:8}       0{form:8d}       2       0")
        for column, (point, component) in enumerate(coordinates):
            rows = [row for row in range(column if form == 6 else 0, len(matrix)) if matrix[row, column]]
            if not rows:
                continue
            if small:
                lines += _small_column(
                    name, point, component, [(*coordinates[row], matrix[row, column]) for row in rows]
                )
                continue
            lines.append(f"DMIG*   {name:16}{point:16d}{component:16d}")
            for row in rows:
                value = f"{matrix[row, column]:.9E}".replace("E", "D")
                lines.append(f"*       {coordinates[row][0]:16d}{coordinates[row][1]:16d}{value:>16}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _small_column(name, point, component, terms):
    """A column between commas, a number without the E of its exponent."""
    lines = [f"DMIG,{name},{point},{component}"]
    for row, part, value in terms:
        mantissa, exponent = f"{value:.9E}".split("E")
        lines.append(f"+,{row},{part},{mantissa}{int(exponent):+d}")
    return lines


def save_extrn(path, coordinates):
    """The file of bulk data beside an .op4 file: its entry EXTRN, four pairs a line."""
    components = {}
    for point, component in coordinates:
        components[point] = components.get(point, "") + str(component)
    pairs = [f"{point:8d}{given:>8}" for point, given in components.items()]
    rows = ["".join(pairs[start : start + 4]) for start in range(0, len(pairs), 4)]
    heads = ["EXTRN"] + [""] * (len(rows) - 1)
    text = "\n".join(
        [
            "BEGIN SUPER     111",
            *(f"{head:8}{row}" for head, row in zip(heads, rows, strict=True)),
        ]
    )
    path.write_text(text + "\n", encoding="utf-8")
    return path


def save_op4(path, matrices, form="text", layout="dense", order="<", width=4):
    """A file of OUTPUT4, text or binary, with all entries ("dense") or strings of entries ("sparse", "bigmat")."""
    parts = []
    for name, matrix in matrices.items():
        rows, columns = matrix.shape
        kind = 4 if np.iscomplexobj(matrix) else 2
        head = (columns, -rows if layout == "bigmat" else rows, 6 if rows == columns else 2, kind)
        parts.append((name, head, [_column(matrix[:, k].copy(), k, layout, width) for k in range(columns)]))
    if form == "text":
        path.write_text("".join(_op4_text(*part) for part in parts), encoding="utf-8")
    else:
        path.write_bytes(b"".join(_op4_binary(*part, order, width) for part in parts))
    return path


def _column(values, place, layout, width):
    """Place, first row (0 without zeros), and strings: (words before the entries, entries)."""
    rows = np.flatnonzero(values)
    if not len(rows):
        return None
    if layout == "dense":
        return place + 1, rows[0] + 1, [((), values[rows[0] : rows[-1] + 1])]
    strings = []
    for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
        entries = values[run]
        length = entries.nbytes // width
        words = (length + 1, run[0] + 1) if layout == "bigmat" else (65536 * (length + 1) + run[0] + 1,)
        strings.append((words, entries))
    return place + 1, 0, strings


def _op4_text(name, head, columns):
    """Matrix as text, three numbers a line."""
    lines = ["".join(f"{value:8d}" for value in head) + f"{name:8}1P,3E23.16"]
    for column in filter(None, columns):
        place, row, strings = column
        words = sum(len(before) + 2 * len(np.atleast_1d(entries)) for before, entries in strings)
        lines.append(f"{place:8d}{row:8d}{words:8d}")
        for before, entries in strings:
            if before:
                lines.append("".join(f"{word:8d}" if len(before) == 2 else f"{word:12d}" for word in before))
            numbers = entries.view(float)
            for start in range(0, len(numbers), 3):
                lines.append("".join(f"{value:23.16E}" for value in numbers[start : start + 3]))
    lines += [f"{head[0] + 1:8d}{1:8d}{1:8d}", f"{1.0:23.16E}"]
    return "\n".join(lines) + "\n"


def _op4_binary(name, head, columns, order, width):
    """Matrix as Fortran records."""
    whole = f"{order}i{width}"

    def record(content):
        length = np.array(len(content), f"{order}i4").tobytes()
        return length + content + length

    letters = [name.ljust(8)[start : start + 4].encode().ljust(width) for start in (0, 4)]
    parts = [record(np.array(head, whole).tobytes() + b"".join(letters))]
    for column in filter(None, columns):
        place, row, strings = column
        content = b"".join(
            np.array(before, whole).tobytes() + entries.view(float).astype(f"{order}f8").tobytes()
            for before, entries in strings
        )
        parts.append(record(np.array([place, row, len(content) // width], whole).tobytes() + content))
    last = np.array([head[0] + 1, 1, 1], whole).tobytes() + np.zeros(1, f"{order}f8").tobytes()
    return b"".join([*parts, record(last)])


def run_of(mass, stiffness, hub, length=1.0, mass_unit=1.0, **other):
    """The run of a structure (SI) in units of its own, normalised to the mass, in axes X aft, Y to the right, Z up."""
    from scipy.linalg import eigh

    values, shapes = eigh(stiffness, mass)
    up, outboard, forward, *turns = hub @ shapes * np.sqrt(mass_unit * length**2)
    motion = np.array([-forward / length, outboard / length, up / length, -turns[2], turns[1], turns[0]])
    return Run(values, np.ones(len(values)), motion, **other)
