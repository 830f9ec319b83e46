// Sampling many surfaces at once. The diffuse ones are put into columns, and go through the formulas of one alone in
// loops without a branch.
#include "core/bsdf/bsdf.hpp"
#include "core/math/columns.hpp"

#include <algorithm>
#include <cassert>

namespace lightnet {
namespace {

struct DiffuseLanes {
    std::size_t count = 0;
    std::array<std::uint32_t, lanes> who;  // of the looks
    Columns3 x, y, z, normal, outgoing;
    Columns2 u;

    Columns3 incoming;
    Column pdf;
    Column agree;  // > 0: shading and geometric normal do, about the viewer's side

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < count; ++i) {
            const Frame frame{x[i], y[i], z[i]};
            const DiffuseStep step = diffuse_step(frame, normal[i], outgoing[i], u[i]);
            incoming.set(i, step.incoming);
            pdf[i] = step.pdf;
            agree[i] = dot(outgoing[i], normal[i]) * dot(outgoing[i], frame.z);
        }
    }
};

}  // namespace

void Bsdf::sample(std::span<const Look> looks, std::span<BsdfSample> samples, std::span<std::uint8_t> found) {
    assert(looks.size() == samples.size() && looks.size() == found.size() && "each look has its sample");
    const auto alone = [&](std::size_t i) {
        const Look& look = looks[i];
        const auto one = look.bsdf.sample(look.outgoing, look.choice, look.u, look.lobes);
        found[i] = one.has_value();
        if (one) samples[i] = *one;
    };
    DiffuseLanes many;
    for (std::size_t first = 0; first < looks.size(); first += lanes) {
        const std::size_t last = std::min(looks.size(), first + lanes);
        many.count = 0;
        for (std::size_t i = first; i < last; ++i) {
            const Look& look = looks[i];
            const Bsdf& bsdf = look.bsdf;
            const bool hidden = bsdf.one_sided_ && dot(look.outgoing, bsdf.normal_) <= 0;
            if (hidden || !bsdf.diffuse() || !(look.lobes & lobe::diffuse)) {
                alone(i);
                continue;
            }
            const std::size_t to = many.count++;
            many.who[to] = static_cast<std::uint32_t>(i);
            many.x.set(to, bsdf.shading_.x);
            many.y.set(to, bsdf.shading_.y);
            many.z.set(to, bsdf.shading_.z);
            many.normal.set(to, bsdf.normal_);
            many.outgoing.set(to, look.outgoing);
            many.u.set(to, look.u);
        }
        work_side_by_side(many);
        for (std::size_t lane = 0; lane < many.count; ++lane) {
            const std::size_t i = many.who[lane];
            if (!(many.agree[lane] > 0)) [[unlikely]] {
                alone(i);
                continue;
            }
            found[i] = many.pdf[lane] != 0;
            samples[i] = {many.incoming[lane], looks[i].bsdf.diffuse()->albedo, many.pdf[lane], lobe::diffuse};
        }
    }
}

}  // namespace lightnet
