#include "tests/fuzz/framed_file.h"

namespace stipple {

Bytes join(const std::vector<Piece>& pieces) {
    Bytes bytes;
    for (const Piece& piece : pieces) {
        bytes.insert(bytes.end(), piece.head.begin(), piece.head.end());
        bytes.insert(bytes.end(), piece.body.begin(), piece.body.end());
    }
    return bytes;
}

}  // namespace stipple
