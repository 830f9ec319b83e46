#include "core/film/clean/returned.hpp"

#include <algorithm>
#include <utility>

#include "core/film/clean/pieces.hpp"

namespace lightnet::cleaning {
namespace {

// With both neighbours, which count half as much each; beyond the picture there is nothing.
void smooth_across(const CellPlane& from, std::size_t across, CellPlane& to) {
    for (std::size_t first = 0; first < from.size(); first += across) {
        const float* const row = from.data() + first;
        float* const out = to.data() + first;
        const auto at = [&](std::size_t x) { return x < across ? row[x] : 0; };  // one less than 0 is beyond, too
        out[0] = 0.5f * row[0] + 0.25f * at(1);
        for (std::size_t x = 1; x + 1 < across; ++x) out[x] = 0.5f * row[x] + 0.25f * (row[x - 1] + row[x + 1]);
        if (across > 1) out[across - 1] = 0.5f * row[across - 1] + 0.25f * at(across - 2);
    }
}
void smooth_down(const CellPlane& from, std::size_t across, CellPlane& to) {
    const CellPlane nothing(across);
    for (std::size_t first = 0; first < from.size(); first += across) {
        const float *const row = from.data() + first, *const above = first ? row - across : nothing.data(),
                           *const below = first + across < from.size() ? row + across : nothing.data();
        for (std::size_t x = 0; x < across; ++x) to[first + x] = 0.5f * row[x] + 0.25f * (above[x] + below[x]);
    }
}

CellPlane smoothed_cells(const CellPlane& plane, const CellGrid& grid, std::int64_t times) {
    CellPlane smooth = plane, across(plane.size());
    for (std::int64_t i = 0; i < times; ++i) {
        smooth_across(smooth, grid.columns.cells(), across);
        smooth_down(across, grid.columns.cells(), smooth);
    }
    return smooth;
}

// Over the cells around each.
CellPlane sums_around(const CellPlane& plane, const CellGrid& grid) {
    const auto across = static_cast<std::int64_t>(grid.columns.cells()),
               down = static_cast<std::int64_t>(grid.rows.cells());
    CellPlane rows(plane.size()), both(plane.size());
    for (std::int64_t y = 0; y < down; ++y)
        add_across(plane.data() + y * across, {0, across}, seen_to_each_side, across, rows.data() + y * across);
    for (std::int64_t y = 0; y < down; ++y)
        for (auto k = std::max<std::int64_t>(0, y - seen_to_each_side); k <= std::min(down - 1, y + seen_to_each_side);
             ++k)
            for (std::int64_t x = 0; x < across; ++x)
                both[static_cast<std::size_t>(y * across + x)] += rows[static_cast<std::size_t>(k * across + x)];
    return both;
}

/// What has been moved so far, and what of it goes back.
class Returning {
public:
    explicit Returning(Moved moved)
        : moved_(std::move(moved)), given_(moved_.planes.size() - Moved::lost, CellPlane(moved_.grid.size())) {}

    // DECISIONS: light-returned-by-cells
    void step(std::int64_t times) {
        std::vector<CellPlane> smooth(Moved::lost);
        each_plane(0, Moved::lost,
                   [&](std::size_t p) { smooth[p] = smoothed_cells(moved_.planes[p], moved_.grid, times); });
        const CellPlane shares = shares_by(smooth);
        each_plane(Moved::change, moved_.planes.size(), [&](std::size_t p) {
            CellPlane& plane = moved_.planes[p];
            if (p >= Moved::lost)
                give(smoothed_cells(plane, moved_.grid, times), shares, plane, given_[p - Moved::lost].data());
            else
                give(smooth[p], shares, plane, nullptr);
        });
    }
    /// To each layer and channel, in parts of brightness.
    const std::vector<CellPlane>& given() const { return given_; }
    const CellGrid& grid() const { return moved_.grid; }

private:
    template <class Action>
    static void each_plane(std::size_t begin, std::size_t end, const Action& action) {
        in_large_pieces(
            end - begin,
            [&](std::size_t first, std::size_t last) {
                for (std::size_t p = first; p < last; ++p) action(begin + p);
            },
            1);
    }

    void give(const CellPlane& smooth, const CellPlane& shares, CellPlane& plane, float* given) const {
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const float back = shares[i] * smooth[i];
            plane[i] -= back * moved_.planes[Moved::brightness][i];
            if (given) given[i] += back;
        }
    }

    // In parts of a cell's smooth brightness. With e, what the noisy mean of both halves is off by, and d, what it was
    // changed by, the squared error of e + p d is least where p is - E[e d] / E[d²]; the rest of 1 is given back. As
    // the halves' noise has nothing in common, E[e d] is a quarter of the product of what both are apart by, before
    // and by the change.
    CellPlane shares_by(const std::vector<CellPlane>& smooth) const {
        const std::size_t cells = moved_.grid.size();
        CellPlane squares(cells), bias(cells);
        for (std::size_t c = 0; c < 3; ++c) {
            const CellPlane &apart = smooth[Moved::apart_of(c)], &first = smooth[Moved::change_of(0, c)],
                            &second = smooth[Moved::change_of(1, c)];
            for (std::size_t i = 0; i < cells; ++i) {
                const float part = 1 / (smooth[Moved::brightness][i] * smooth[Moved::brightness][i]);
                const float both = first[i] + second[i], noise = (first[i] - second[i]) * apart[i];
                squares[i] += both * both * part;
                bias[i] += (both * both + noise) * part;
            }
        }
        squares = sums_around(squares, moved_.grid), bias = sums_around(bias, moved_.grid);
        for (std::size_t i = 0; i < cells; ++i) {
            const float part = bias[i] > 0 && squares[i] > 0 ? std::min(1.0f, bias[i] / squares[i]) : 0;
            bias[i] = part / smooth[Moved::brightness][i];
        }
        return bias;
    }

    Moved moved_;
    std::vector<CellPlane> given_;
};

/// Pixels of some rows of a layer, to which is given what their cells get.
class Giving {
public:
    Giving(const Returning& returning, std::uint32_t width)
        : given_(returning.given()), grid_(returning.grid()), cells_(grid_.columns.cells()) {
        for (std::uint32_t x = 0; x < width; ++x) columns_.push_back(grid_.columns.between(x));
    }
    void give(std::size_t layer, std::size_t y, const float* brightness, Rgb* pixels) {
        take_row(layer, grid_.rows.between(static_cast<std::int64_t>(y)));
        for (std::size_t x = 0; x < columns_.size(); ++x) {
            const auto& [lower, upper, way] = columns_[x];
            const Rgb given = (cells_[lower] * (1 - way) + cells_[upper] * way) * brightness[x];
            pixels[x] = {lit(pixels[x].r, given.r), lit(pixels[x].g, given.g), lit(pixels[x].b, given.b)};
        }
    }

private:
    void take_row(std::size_t layer, const CellAxis::Between& between) {
        const auto& [lower, upper, way] = between;
        const auto at = [&](std::size_t channel, std::size_t x) {
            const CellPlane& plane = given_[3 * layer + channel];
            return plane[lower * cells_.size() + x] * (1 - way) + plane[upper * cells_.size() + x] * way;
        };
        for (std::size_t x = 0; x < cells_.size(); ++x) cells_[x] = {at(0, x), at(1, x), at(2, x)};
    }

    const std::vector<CellPlane>& given_;
    const CellGrid& grid_;
    std::vector<CellAxis::Between> columns_;
    std::vector<Rgb> cells_;  // of the row
};

}  // namespace

void return_light(Moved moved, const std::vector<float>& brightness, Picture& picture) {
    constexpr std::size_t rows_of_piece = 16;
    Returning returning(std::move(moved));
    for (const auto times : smoothings) returning.step(times);
    in_large_pieces(
        picture.height,
        [&](std::size_t first, std::size_t last) {
            Giving giving(returning, picture.width);
            for (std::size_t l = 0; l < std::max<std::size_t>(1, picture.layers.size()); ++l)
                for (std::size_t y = first; y < last; ++y)
                    giving.give(l, y, brightness.data() + y * picture.width,
                                (picture.layers.empty() ? picture.beauty : picture.layers[l].pixels).data() +
                                    y * picture.width);
        },
        rows_of_piece);
}

}  // namespace lightnet::cleaning
