#include "core/film/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstddef>

#include "core/film/compare.hpp"

namespace lightnet {
namespace {

/// min |A x - b|² by its normal equations, which are small: as many unknowns as layers.
struct NormalEquations {
    explicit NormalEquations(Eigen::Index unknowns)
        : square(Eigen::MatrixXd::Zero(unknowns, unknowns)), right(Eigen::VectorXd::Zero(unknowns)) {}
    void add(const Eigen::VectorXd& row, double wanted) {
        square.selfadjointView<Eigen::Lower>().rankUpdate(row);
        right += wanted * row;
    }
    Eigen::MatrixXd square;  // AᵀA; its lower half
    Eigen::VectorXd right;   // Aᵀb
};

using Indices = std::vector<Eigen::Index>;

// The best x where only those of `free` may differ from 0.
Eigen::VectorXd best_of(const NormalEquations& equations, const Indices& free) {
    const Eigen::MatrixXd all = equations.square.selfadjointView<Eigen::Lower>();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(equations.right.size());
    const Eigen::MatrixXd square = all(free, free);
    const Eigen::VectorXd right = equations.right(free), best = square.ldlt().solve(right);
    x(free) = best;
    return x;
}

// How far from `x` towards `wanted` none of `free` falls below 0.
double step_to(const Eigen::VectorXd& x, const Eigen::VectorXd& wanted, const Indices& free) {
    double step = 1;
    for (const auto i : free)
        if (wanted[i] <= 0) step = std::min(step, x[i] / (x[i] - wanted[i]));
    return step;
}

// The unknown whose growth makes the error less, and fastest; none: x is best.
Eigen::Index next_free(const Eigen::VectorXd& slope, const Indices& free, double little) {
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < slope.size(); ++i) {
        const bool held = std::find(free.begin(), free.end(), i) == free.end();
        if (held && slope[i] > little && (best < 0 || slope[i] > slope[best])) best = i;
    }
    return best;
}

Eigen::VectorXd non_negative_least_squares(const NormalEquations& equations) {
    const auto unknowns = equations.right.size();
    const Eigen::MatrixXd all = equations.square.selfadjointView<Eigen::Lower>();
    const double little = 1e-10 * equations.right.cwiseAbs().maxCoeff();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns);
    Indices free;
    for (Eigen::Index round = 0; round < 3 * unknowns; ++round) {  // it ends by itself but for rounding
        const auto next = next_free(equations.right - all * x, free, little);
        if (next < 0) break;
        free.push_back(next);
        for (double step = 0; step < 1 && !free.empty();) {
            const Eigen::VectorXd wanted = best_of(equations, free);
            step = step_to(x, wanted, free);
            x += step * (wanted - x);
            if (step >= 1) break;
            const double zero = 1e-12 * x.cwiseAbs().maxCoeff();
            std::erase_if(free, [&](Eigen::Index i) {
                if (wanted[i] > 0 || x[i] > zero) return false;
                x[i] = 0;
                return true;
            });
        }
    }
    return x;
}

float channel_of(const Rgb& colour, std::size_t channel) { return std::array{colour.r, colour.g, colour.b}[channel]; }

void add_pixels(NormalEquations& equations, const Picture& picture, const Picture& target, std::size_t channel) {
    Eigen::VectorXd row(equations.right.size());
    for (std::size_t i = 0; i < target.beauty.size(); ++i) {
        bool sound = finite(target.beauty[i]);
        for (Eigen::Index k = 0; k < row.size(); ++k) {
            const Rgb& colour = picture.layers[std::size_t(k)].pixels[i];
            sound = sound && finite(colour);
            row[k] = channel_of(colour, channel);
        }
        if (sound) equations.add(row, channel_of(target.beauty[i], channel));
    }
}

}  // namespace

std::vector<Gain> fit(const Picture& picture, const Picture& target, bool grey) {
    refuse_other_size(target, picture);
    const auto layers = Eigen::Index(picture.layers.size());
    std::array<Eigen::VectorXd, 3> found;
    NormalEquations together(layers);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        NormalEquations alone(layers);
        NormalEquations& equations = grey ? together : alone;
        add_pixels(equations, picture, target, channel);
        if (!grey) found[channel] = non_negative_least_squares(equations);
    }
    if (grey) found.fill(non_negative_least_squares(together));
    std::vector<Gain> gains;
    for (std::size_t k = 0; k < picture.layers.size(); ++k) {
        const auto value = [&](std::size_t channel) { return float(found[channel][Eigen::Index(k)]); };
        gains.push_back({picture.layers[k].name, {value(0), value(1), value(2)}});
    }
    return gains;
}

}  // namespace lightnet
