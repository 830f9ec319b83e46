#include "core/film/clean/regression.hpp"

#include <algorithm>

#include "core/base/math/columns.hpp"

namespace lightnet::cleaning {
namespace {

constexpr float damping = 0.01f;          // of a slope, in parts of the feature's variance
constexpr float least_noise = 1e-6f;      // of a feature, whose range is about 1
constexpr float least_variation = 1e-3f;  // of a feature over a window, so that it counts
constexpr std::array<Place, 5> compared{{{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};  // means around two pixels

// Of each place of the window, in parts of the centre's: it ends gently, so that no step shows where one does; nothing
// at the ends of its rows, where vectors are longer.
constexpr std::array<float, 8 * window_vectors> nearness_to_the_centre() {
    std::array<float, 8 * window_vectors> all{};
    const auto along = [](std::size_t place) {
        const float off = (static_cast<float>(place) - reach) / (reach + 1);
        return 1 - off * off;
    };
    for (std::size_t y = 0; y < window_rows; ++y)
        for (std::size_t x = 0; x < window_rows; ++x) all[y * 8 * row_vectors + x] = along(x) * along(y);
    return all;
}
alignas(64) constexpr auto nearness = nearness_to_the_centre();

/// All regressions of a centre, with scratch.
struct Regressing {
    const Guide& guide;
    Centre& centre;
    Regressions& regressions;
    Planes planes;
    Cells distances, weighted;
    double moments[most_unknowns][most_unknowns];  // below the diagonal

    Regressing(const Guide& all, Centre& one, Regressions& out) : guide(all), centre(one), regressions(out) {}

    [[gnu::always_inline]] void work() {
        find_features();
        for (std::size_t half = 0; half < 2; ++half) {
            compare(guide.means[1 - half]);
            for (std::size_t f = 0; f < filters; ++f) {
                Regression& regression = regressions[half][f];
                weigh(tolerance[f], regression.weights);
                collect(regression.weights);
                damp();
                invert(regression);
            }
        }
    }

private:
    [[gnu::always_inline]] void find_features() {
        const float* const inside = corner_of(guide.inside, centre.at);
        centre.features = 0;
        for (std::size_t f = 0; f < guide.features.size(); ++f) {
            Cells& plane = planes[centre.unknowns()];
            plane_of(guide.features[f], centre.at, plane);
            Eight most = all_of(0.0f);
            for (std::size_t k = 0; k < window_vectors; ++k)
                most = greater_of(most, magnitude(plane[k]) * eight_at(inside + offset_of(k, guide.inside.stride())));
            if (greatest_of(most) > least_variation) centre.which[centre.features++] = static_cast<std::uint8_t>(f);
        }
    }

    // How far colours are apart in parts of their noise, squared: what noise explains is taken from it.
    [[gnu::always_inline]] void compare(const Colours& means) {
        for (auto& sum : distances.all) sum = all_of(0.0f);
        for (const Place& off : compared)
            for (std::size_t c = 0; c < 3; ++c) {
                const Place at{centre.at.x + off.x, centre.at.y + off.y};
                const float here = *means[c].at(at.x, at.y), noise = *guide.variance[c].at(at.x, at.y);
                const float* const others = corner_of(means[c], at);
                const float* const noises = corner_of(guide.variance[c], at);
                for (std::size_t k = 0; k < window_vectors; ++k) {
                    const std::size_t i = offset_of(k, means[c].stride());
                    const Eight apart = eight_at(others + i) - here, other_noise = eight_at(noises + i);
                    distances[k] += (apart * apart - (noise + lesser_of(other_noise, all_of(noise)))) /
                                    (other_noise + (noise + 1e-10f));
                }
            }
    }

    // (1 - x / 8)^8 is an exponential that ends.
    [[gnu::always_inline]] void weigh(float deviations, Cells& weights) const {
        const float scale = 1 / (8 * 3 * float(compared.size()) * deviations * deviations);
        const float* const inside = corner_of(guide.inside, centre.at);
        for (std::size_t k = 0; k < window_vectors; ++k) {
            const Eight apart = greater_of(distances[k], all_of(0.0f));
            Eight weight = greater_of(1 - apart * scale, all_of(0.0f));
            weight *= weight, weight *= weight, weight *= weight;
            weights[k] = weight * eight_at(inside + offset_of(k, guide.inside.stride())) * eight_at(&nearness[8 * k]);
        }
    }

    [[gnu::always_inline]] void collect(const Cells& weights) {
        for (std::size_t a = 0; a < centre.unknowns(); ++a) {
            for (std::size_t k = 0; k < window_vectors; ++k) weighted[k] = a ? weights[k] * planes[a][k] : weights[k];
            Eight sum = all_of(0.0f);
            for (std::size_t k = 0; k < window_vectors; ++k) sum += weighted[k];
            moments[a][0] = sum_of(sum);
            for (std::size_t b = 1; b <= a; ++b) {
                Eight even = all_of(0.0f), odd = even;  // two sums are not waited for as one is
                for (std::size_t k = 0; k < window_vectors; k += 2)
                    even += weighted[k] * planes[b][k], odd += weighted[k + 1] * planes[b][k + 1];
                moments[a][b] = sum_of(even + odd);
            }
        }
    }

    [[gnu::always_inline]] void damp() {
        for (std::size_t a = 1; a < centre.unknowns(); ++a) {
            const float noise = *guide.features[centre.which[a - 1]].noise.at(centre.at.x, centre.at.y);
            moments[a][a] += damping * moments[a][a] + moments[0][0] * (double{noise} + least_noise);
        }
    }

    // By Cholesky's way without roots.
    [[gnu::always_inline]] void invert(Regression& regression) const {
        const std::size_t n = centre.unknowns();
        double lower[most_unknowns][most_unknowns], per_diagonal[most_unknowns], back[most_unknowns][most_unknowns];
        for (std::size_t a = 0; a < n; ++a) {
            double row[most_unknowns], sum = moments[a][a];
            for (std::size_t b = 0; b < a; ++b) {
                row[b] = moments[a][b];
                for (std::size_t k = 0; k < b; ++k) row[b] -= row[k] * lower[b][k];
                lower[a][b] = row[b] * per_diagonal[b];
                sum -= row[b] * lower[a][b];
            }
            per_diagonal[a] = 1 / (sum > 1e-30 ? sum : 1e-30);
        }
        for (std::size_t a = 0; a < n; ++a) {
            back[a][a] = 1;
            for (std::size_t b = 0; b < a; ++b) {
                back[a][b] = -lower[a][b];
                for (std::size_t k = b + 1; k < a; ++k) back[a][b] -= lower[a][k] * back[k][b];
            }
        }
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b <= a; ++b) {
                double sum = 0;
                for (std::size_t k = a; k < n; ++k) sum += back[k][a] * back[k][b] * per_diagonal[k];
                regression.inverse[a][b] = regression.inverse[b][a] = moments[0][0] > 0 ? static_cast<float>(sum) : 0;
            }
    }
};

}  // namespace

void regress(const Guide& guide, Centre& centre, Regressions& regressions) {
    Regressing regressing(guide, centre, regressions);
    work_in_lanes(regressing);
}

}  // namespace lightnet::cleaning
