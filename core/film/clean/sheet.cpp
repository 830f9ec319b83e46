#include "core/film/clean/sheet.hpp"

#include <algorithm>

#include "core/base/thread_pool.hpp"

namespace lightnet::cleaning {
namespace {

constexpr std::size_t rows_of_piece = 32;

}  // namespace

Sheet::Sheet(std::uint32_t width, std::uint32_t height)
    : stride_(up_to_cores(width) + 2 * margin), values_(stride_ * (up_to_cores(height) + 2 * margin)) {}

Sheet Sheet::of_zeros(std::uint32_t width, std::uint32_t height) {
    Sheet sheet(width, height);
    std::fill(sheet.values_.begin(), sheet.values_.end(), 0.0f);
    return sheet;
}

void Sheet::extend(std::uint32_t width, std::uint32_t height) {
    const std::size_t rows = values_.size() / stride_;
    for (std::uint32_t y = 0; y < height; ++y) {
        float* row = at(0, y) - margin;
        std::fill(row, row + margin, row[margin]);
        std::fill(row + margin + width, row + stride_, row[margin + width - 1]);
    }
    const float* first = at(0, 0) - margin;
    const float* last = at(0, height - 1) - margin;
    for (std::size_t y = 0; y < rows; ++y)
        if (y < margin || y >= margin + height)
            std::copy_n(y < margin ? first : last, stride_, values_.data() + y * stride_);
}

void add_across(const float* row, Inside inside, std::int64_t radius, std::int64_t width, float* sums) {
    for (std::int64_t off = -radius; off <= radius; ++off) {
        const std::int64_t end = std::min(width, inside.end - off);
        for (std::int64_t x = std::max<std::int64_t>(0, inside.first - off); x < end; ++x) sums[x] += row[x + off];
    }
}

Sheet smoothed(std::uint32_t width, std::uint32_t height, std::uint32_t radius, const RowOfSheet& row_of) {
    Sheet smooth(width, height);
    const auto r = static_cast<std::int64_t>(radius), w = std::int64_t{width}, h = std::int64_t{height};
    const Inside inside{0, w};
    // Each sum is made anew in the same order, so that a pixel knows nothing of where its row began, nor of where its
    // piece did, which makes the rows around it as well.
    parallel_for(
        height,
        [&](std::size_t first, std::size_t last) {
            const auto top = static_cast<std::int64_t>(first), end = static_cast<std::int64_t>(last);
            const std::int64_t begin = std::max<std::int64_t>(0, top - r), rows = std::min(h, end + r) - begin;
            std::vector<float> across(static_cast<std::size_t>(rows * w)), scratch(width);
            for (std::int64_t y = 0; y < rows; ++y) {
                float* const sums = across.data() + y * w;
                add_across(row_of(begin + y, scratch.data()), inside, r, w, sums);
                for (std::int64_t x = 0; x < w; ++x) sums[x] /= static_cast<float>(inside.count(x, r));
            }
            for (std::int64_t y = top; y < end; ++y) {
                const std::int64_t from = std::max<std::int64_t>(0, y - r), to = std::min(h - 1, y + r);
                float* const sums = smooth.at(0, y);
                std::fill_n(sums, w, 0.0f);
                for (std::int64_t k = from; k <= to; ++k)
                    for (std::int64_t x = 0; x < w; ++x)
                        sums[x] += across[static_cast<std::size_t>((k - begin) * w + x)];
                for (std::int64_t x = 0; x < w; ++x) sums[x] /= static_cast<float>(to - from + 1);
            }
        },
        rows_of_piece);
    smooth.extend(width, height);
    return smooth;
}

Sheet smoothed(const Sheet& sheet, std::uint32_t width, std::uint32_t height, std::uint32_t radius) {
    return smoothed(width, height, radius, [&](std::int64_t y, float*) { return sheet.at(0, y); });
}

}  // namespace lightnet::cleaning
