"""The sample stream as docs/stream_format.md has it, apart from the program's own reader."""

import struct

HEADER_BYTES, MARKER_BYTES = 36, 20  # of a packet; the end marker
PACKET, END = b"\xc5SPK", b"\xc5END"
INDEX = 3


def table_entry(byte):
    for _ in range(8):
        byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
    return byte


TABLE = [table_entry(byte) for byte in range(256)]


def crc32c(data, other=0):
    """CRC-32C of `data`, continued from `other`."""
    crc = other ^ 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def parts(content):
    """Header, packets (the index is the last one) and end marker of a whole stream."""
    at = struct.unpack_from("<I", content, 12)[0]
    header, packets = content[:at], []
    while content[at:at + 4] == PACKET:
        end = at + HEADER_BYTES + struct.unpack_from("<I", content, at + 24)[0]
        packets.append(content[at:end])
        at = end
    return header, packets, content[at:]


def samples(content):
    """All of the packets that does not depend on the header (their CRCs do) nor on offsets (the
    index has those)."""
    packets = parts(content)[1]
    return [packet[:32] + packet[HEADER_BYTES:] for packet in packets if packet[4] != INDEX]


def sealed(header, packets, marker):
    """A stream of these parts, in which all CRCs are those that the page asks for."""
    header = header[:-4] + struct.pack("<I", crc32c(header[:-4]))
    seed = checksum = crc32c(header[:-4])
    content = header
    for packet in packets:
        packet = packet[:28] + struct.pack("<I", crc32c(packet[HEADER_BYTES:])) + packet[32:]
        crc = struct.pack("<I", crc32c(packet[:32], seed))
        checksum = crc32c(crc, checksum)
        content += packet[:32] + crc + packet[HEADER_BYTES:]
    marker = marker[:12] + struct.pack("<I", checksum)
    return content + marker + struct.pack("<I", crc32c(marker, seed))
