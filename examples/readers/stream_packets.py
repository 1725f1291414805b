"""Rules of packets, and their samples, as docs/stream_format.md says."""

import struct


def sample_fault(head, fields, early, payload):
    """The first rule that a packet of kind 1 breaks, or None. `early`: it begins before the end of the one before."""
    flags, reserved, slot, row, rows, samples = fields
    bits = samples * head["bit_depth"]
    rules = (("reserved bytes", lambda: reserved == 0), ("flags", lambda: flags < 4), ("slot", lambda: slot < 2**53),
             ("rows", lambda: rows > 0 and row + rows <= head["rows"]), ("order", lambda: not early),
             ("length", lambda: len(payload) == (bits + 7) // 8),
             ("samples", lambda: samples == (0 if flags & 2 else due_samples(head, slot, range(row, row + rows)))),
             ("unused bits", lambda: bits % 8 == 0 or payload[-1] >> bits % 8 == 0))
    return next((name for name, holds in rules if not holds()), None)


def due_samples(head, slot, rows):
    """Number of samples of these rows that are due at the end of the slot."""
    schedule, count = head["schedule"], 0
    period, tile_rows, tile_cols = (schedule[key] for key in ("period_slots", "tile_rows", "tile_cols"))
    for row in rows:
        for col in range(head["cols"]):
            for first, mask in schedule["exposures"][row % tile_rows * tile_cols + col % tile_cols]:
                span = mask.bit_length()
                count += slot % period == (first + span - 1) % period and slot >= span - 1
    return count * head["planes"]


def unpack(payload, samples, depth):
    string = int.from_bytes(payload, "little")
    return [string >> i * depth & (1 << depth) - 1 for i in range(samples)]


def index_fault(fields, slots, count, payload, early, limit):
    """The first rule that an index breaks, or None. `early`: it counts too few slots. `limit`: of its offsets."""
    if any(fields) or slots >= 2**53 or early or len(payload) != 16 * count:
        return "fields of the index"
    before = (-1, -1)
    for slot, offset in struct.iter_unpack("<QQ", payload):
        if slot <= before[0] or offset <= before[1] or slot >= slots or offset >= limit:
            return "entries of the index"
        before = (slot, offset)
    return None
