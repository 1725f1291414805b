"""The figures in the conclusions of README.md, rivals.md, camera_map.md, explored_spaces.md and concept.md are those of
the tables in docs/."""

import re

from tree import report

README, RIVALS, MAP = "README.md", "docs/rivals.md", "docs/camera_map.md"
EXPLORED, CONCEPT = "docs/explored_spaces.md", "docs/concept.md"
CODED = ("coded", "hardware", "pixel flutter")
FRAMES = ("1x vbm4d", "4x best", "alternating kang2003", "binned naive", "binned vbm4d", "charge-binned vbm4d")


def table_after(text, begin):
    """The first table after the text `begin`, by the first cell of the row and the column. "31.4 / 33.9 / 33.2" is a list of
    numbers, of "31.4 ± 0.7" the first counts."""
    head, _, *rows = re.search(r"(?:^\|.*\n)+", text[text.index(begin):], re.MULTILINE)[0].splitlines()
    names = [name.replace("`", "").strip() for name in head.strip("|").split("|")]
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    return {row[0]: {name: [number(part) for part in cell.split("/")] for name, cell in zip(names[1:], row[1:])}
            for row in cells}


def number(cell):
    """The cell itself if it is none."""
    try:
        return float(cell.split("±")[0])
    except ValueError:
        return cell


def lead(table, clip, figure=0):
    """dB of `hardware best` above the best camera of frames, which may be binned."""
    return table["hardware best"][clip][figure] - max(table[system][clip][figure] for system in FRAMES)


def of_rivals(text):
    table = table_after(text, "<!-- strongest -->")
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
    yield from of_learned(text)


def of_learned(text):
    table = table_after(text, "<!-- learned -->")

    def added(system, clip):
        before, after = (table[system.format(method)][clip][0] for method in ("best", "learned"))
        return after - before

    def ahead(method, clip):
        frames = max(table[f"{system} {method}"][clip][0] for system in ("1x", "4x", "binned"))
        return table[f"hardware {method}"][clip][0] - frames

    clips = [name for name in table["coded best"] if name not in ("samples", "mouse250_a")]
    gains = [added("hardware {}", clip) for clip in clips]
    shifts = [ahead("learned", clip) - ahead("best", clip) for clip in clips]
    yield f"adds {min(gains):.1f} to {max(gains):.1f} dB to `hardware best`"
    yield f"shifts by {min(shifts):.1f} to {max(shifts):.1f} dB in favour of coded exposure"
    yield f"On `mouse250_a` it takes {-added('hardware {}', 'mouse250_a'):.1f} dB"
    yield f"up to {max(added('4x {}', clip) for clip in clips):.1f} dB (`nat30_coffee`)"
    yield f"up to {-min(added('full rate {} (4 x samples)', clip) for clip in clips):.1f} dB (`roll`)"


def of_explored(text):
    def column(space, name):
        return {row: cells[name][0] for row, cells in table_after(text, f"<!-- {space}.toml -->").items()}
    rate, energy = column("lux1310_3000", "slots/s"), column("lux1310_3000", "uJ per slot")
    yield f"at {rate['hardware_tiled']:.0f} slots/s, `random` at {rate['random']:.0f}"
    yield f"for {energy['full4x'] / energy['random']:.2f} of the energy per slot"
    psnr = column("exposure_lengths", "PSNR, dB")
    yield f"`[1, 4]` and `[1, 2, 4]` have {psnr['[ 1, 4 ]']:.1f} and {psnr['[ 1, 2, 4 ]']:.1f} dB"
    yield f"for {psnr['[ 1, 2, 4 ]'] - psnr['[ 1, 2, 4, 8 ]']:.1f} dB"
    psnr, rate = column("group_size", "PSNR, dB"), column("group_size", "readout, slots/s")
    costs = [psnr["1"] - psnr[groups] for groups in ("2", "4", "16")]
    yield "groups of 2 cost {:.1f} dB, of 4 {:.1f} dB, of 16 {:.1f} dB of PSNR".format(*costs)
    yield f"{min(rate.values()):.0f} to {max(rate.values()):.0f} slots/s"


def deficits(text):
    """dB of `hardware best` behind the best camera of a cell: mean, worst; the least worst of the cameras of frames."""
    table = {row: (cells["mean, dB"][0], cells["worst cell, dB"][0]) for row, cells in table_after(text, "One camera for").items()}
    return *table["hardware best"], min(worst for row, (_, worst) in table.items() if not row.startswith(CODED))


def of_map(text):
    mean, worst, frames = deficits(text)
    yield f"{mean:.1f} dB behind the best camera of each cell at the mean and {worst:.1f} dB at most"
    yield f"by {frames:.1f} dB or more"


def of_concept(text):
    decoded = {camera: cells["decoded by best"][0] for camera, cells in table_after(text, "Quality of the videos").items()}
    yield f"{decoded['coded'] - max(decoded['1x exposure'], decoded['4x exposure']):.1f} dB better here"


CONCLUSIONS = {RIVALS: of_rivals, MAP: of_map, EXPLORED: of_explored, CONCEPT: of_concept}


def of_readme(text):
    """`text` is the page of the map."""
    _, worst, frames = deficits(text)
    yield f"at most {worst:.1f} dB behind the best camera for a scene, each of the others {frames:.1f} dB or more"


def check(tree):
    pages = [(page, page, conclusions) for page, conclusions in CONCLUSIONS.items()] + [(README, MAP, of_readme)]
    for page, source, conclusions in pages:
        if page not in tree.files or source not in tree.files:
            continue
        prose = " ".join(tree.text(page).split())
        for conclusion in conclusions(tree.text(source)):
            if conclusion not in prose:
                yield f'{page}: the conclusions do not say "{conclusion}", as the table of {source} does'


if __name__ == "__main__":
    report(check)
