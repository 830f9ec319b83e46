#include "core/film/clean/changes.hpp"

#include "core/base/math/columns.hpp"

namespace lightnet::cleaning {
namespace {

std::size_t corner_in(Place area, Place centre) {
    return AreaChannels::index(centre.x - area.x - std::int64_t{reach}, centre.y - area.y - std::int64_t{reach});
}

/// Changes of the pixels of a window, with scratch.
struct Changing {
    const Guide& guide;
    const Centre& centre;
    const Regressions& regressions;
    const std::array<AreaChannels, 2>& values;
    const Wanted& wanted;
    std::size_t corner, here;  // of the window and of its centre, in channels
    Planes planes;
    std::array<Cells, 3> off, weighted;  // colours less those of the centre
    float plane[3][most_unknowns];

    Changing(const Guide& all, const Centre& one, const Regressions& fitted, const std::array<AreaChannels, 2>& colours,
             Place area, const Wanted& out)
        : guide(all),
          centre(one),
          regressions(fitted),
          values(colours),
          wanted(out),
          corner(corner_in(area, one.at)),
          here(corner + reach * (AreaChannels::stride + 1)) {}

    [[gnu::always_inline]] void work() {
        for (std::size_t a = 1; a < centre.unknowns(); ++a)
            plane_of(guide.features[centre.which[a - 1]], centre.at, planes[a]);
        for (std::size_t half = 0; half < 2; ++half) {
            if (!wanted[half][0].changes && !wanted[half][1].changes) continue;
            take(values[half]);
            for (std::size_t f = 0; f < filters; ++f) {
                if (!wanted[half][f].changes) continue;
                fit(regressions[half][f]);
                add(regressions[half][f], wanted[half][f]);
            }
        }
    }

private:
    static_assert(filters == 2, "both are asked for");

    [[gnu::always_inline]] void take(const AreaChannels& from) {
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < window_vectors; ++k)
                off[c][k] = eight_at(from.of(c) + corner + offset_of(k, AreaChannels::stride)) - from.of(c)[here];
    }

    [[gnu::always_inline]] void fit(const Regression& regression) {
        float right[3][most_unknowns];
        Eight r = all_of(0.0f), g = r, b = r;
        for (std::size_t k = 0; k < window_vectors; ++k) {
            const Eight weight = regression.weights[k];
            r += weighted[0][k] = weight * off[0][k];
            g += weighted[1][k] = weight * off[1][k];
            b += weighted[2][k] = weight * off[2][k];
        }
        right[0][0] = sum_of(r), right[1][0] = sum_of(g), right[2][0] = sum_of(b);
        for (std::size_t a = 1; a < centre.unknowns(); ++a) {
            r = g = b = all_of(0.0f);
            for (std::size_t k = 0; k < window_vectors; ++k) {
                const Eight feature = planes[a][k];
                r += weighted[0][k] * feature, g += weighted[1][k] * feature, b += weighted[2][k] * feature;
            }
            right[0][a] = sum_of(r), right[1][a] = sum_of(g), right[2][a] = sum_of(b);
        }
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t a = 0; a < centre.unknowns(); ++a) {
                plane[c][a] = 0;
                for (std::size_t k = 0; k < centre.unknowns(); ++k)
                    plane[c][a] += regression.inverse[a][k] * right[c][k];
            }
    }

    [[gnu::always_inline]] void add(const Regression& regression, const WantedChanges& out) {
        float* const to[3] = {out.changes->of(0) + corner, out.changes->of(1) + corner, out.changes->of(2) + corner};
        for (std::size_t k = 0; k < window_vectors; ++k) {
            Eight r = plane[0][0] - off[0][k], g = plane[1][0] - off[1][k], b = plane[2][0] - off[2][k];
            for (std::size_t a = 1; a < centre.unknowns(); ++a) {
                const Eight feature = planes[a][k];
                r += plane[0][a] * feature, g += plane[1][a] * feature, b += plane[2][a] * feature;
            }
            const std::size_t i = offset_of(k, AreaChannels::stride);
            Eight weight = regression.weights[k] * out.part;
            if (out.scale) weight *= eight_at(out.scale + corner + i);
            put(eight_at(to[0] + i) + weight * r, to[0] + i);
            put(eight_at(to[1] + i) + weight * g, to[1] + i);
            put(eight_at(to[2] + i) + weight * b, to[2] + i);
        }
    }
};

}  // namespace

void add_changes(const Guide& guide, const Centre& centre, const Regressions& regressions,
                 const std::array<AreaChannels, 2>& values, Place area, const Wanted& wanted) {
    Changing changing(guide, centre, regressions, values, area, wanted);
    work_in_lanes(changing);
}

void add_weights(const Centre& centre, const Regression& regression, float part, Place area, float* sums) {
    float* const first = sums + corner_in(area, centre.at);
    for (std::size_t k = 0; k < window_vectors; ++k) {
        float* const at = first + offset_of(k, AreaChannels::stride);
        put(eight_at(at) + part * regression.weights[k], at);
    }
}

}  // namespace lightnet::cleaning
