#pragma once

#include <cassert>
#include <cstddef>
#include <span>

namespace stipple {

/// A view of one image plane, rows packed without gaps. Owns nothing.
template <typename T>
class PlaneView {
  public:
    PlaneView(T* data, int rows, int cols) : data_(data), rows_(rows), cols_(cols) {}

    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] T* data() const { return data_; }

    /// Precondition: 0 <= row < rows().
    [[nodiscard]] std::span<T> row(int row) const {
        assert(row >= 0 && row < rows_);
        const auto width = static_cast<std::size_t>(cols_);
        return {data_ + static_cast<std::size_t>(row) * width, width};
    }
    /// Precondition: 0 <= row < rows(), 0 <= col < cols().
    [[nodiscard]] T& operator()(int row, int col) const {
        return this->row(row)[static_cast<std::size_t>(col)];
    }

  private:
    T* data_;
    int rows_;
    int cols_;
};

}  // namespace stipple
