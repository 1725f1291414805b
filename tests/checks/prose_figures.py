"""The figures in the conclusions of docs/rivals.md are those of the table above them."""

import re

from tree import report

PAGE = "docs/rivals.md"
FRAMES = ("1x vbm4d", "4x best", "alternating kang2003", "binned naive", "binned vbm4d", "charge-binned vbm4d")


def table_of(text):
    """By system and column; a cell "31.4 / 33.9 / 33.2" is a list of numbers."""
    head, _, *rows = re.search(r"<!-- strongest -->\n(.*?)\n\n", text, re.DOTALL)[1].splitlines()
    names = [name.strip(" `") for name in head.strip("|").split("|")]
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    return {row[0]: {name: [float(number) for number in cell.split("/")] for name, cell in zip(names[1:], row[1:])}
            for row in cells}


def lead(table, clip, figure=0):
    """dB of `hardware best` above the best camera of frames, which may be binned."""
    return table["hardware best"][clip][figure] - max(table[system][clip][figure] for system in FRAMES)


def expected(table):
    """Each conclusion with the figures of the table."""
    leads = sorted(lead(table, clip) for clip in ("hdr_desk_fg", "nat30_coffee", "hdr_stilllife"))
    clips = [name for name, cell in table["coded best"].items() if len(cell) == 3]
    costs = [table["full rate best (4 x samples)"][clip][0] - table["hardware best"][clip][0] for clip in clips]
    binned = table["charge-binned vbm4d"]
    flutter = table["pixel flutter best"]["nat30_coffee"][0] - table["coded best"]["nat30_coffee"][0]
    rates = [table[system]["slots/s"][0] for system in ("4x best", "binned vbm4d", "hardware best", "coded best")]
    yield f"{leads[0]:.1f} to {leads[-1]:.1f} dB ahead"
    yield f"{lead(table, 'nat30_blocks'):.1f} dB ({lead(table, 'nat30_blocks', 1):.1f} dB after 1/2.2)"
    yield (f"on `mouse250_a` by {binned['mouse250_a'][0] - table['hardware best']['mouse250_a'][0]:.1f} dB, on `mouse250_b` "
           f"by {binned['mouse250_b'][0] - table['hardware best']['mouse250_b'][0]:.1f} dB")
    yield f"by {-lead(table, 'pan'):.1f} dB on `pan` and by {-lead(table, 'roll'):.1f} dB on `roll`"
    yield f"`nat30_coffee`, by {flutter:.1f} dB"
    yield f"costs {min(costs):.0f} to {max(costs):.0f} dB"
    yield "run at {:.0f} slots/s, binned ones at {:.0f}, `hardware_tiled` at {:.0f}, `random` at {:.0f}".format(*rates)
    yield f"{table['coded best']['uJ/slot'][0] / table['4x best']['uJ/slot'][0]:.1f} times the energy"


def check(tree):
    text = tree.text(PAGE)
    prose = " ".join(text.split())
    for conclusion in expected(table_of(text)):
        if conclusion not in prose:
            yield f'{PAGE}: the conclusions do not say "{conclusion}", as the table does'


if __name__ == "__main__":
    report(check)
