// What models with gloss cost in columns: processor time of one point among many, beside that of a point alone.
//
// One is what a light path does at a point: the model as it is seen, its value and density for a lamp, and a way on
// with its weight. Both go by one formula (DECISIONS: one-formula), so what they find is compared, too, to the bit.
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/bsdf/coated_diffuse.hpp"
#include "core/scene/bsdf/conductor.hpp"
#include "core/scene/bsdf/model_columns.hpp"
#include "core/scene/bsdf/principled.hpp"
#include "tests/bench/figure.hpp"

namespace lightnet::bench {
namespace {

const int turns = repeated(9), rounds = sized(4000, 1);
constexpr double most = 0.6;  // of the time of a point alone

template <class Seen>
struct Points {
    std::vector<typename Seen::Model> models;
    ModelColumns<Seen> columns;
    Columns3 outgoing, to_lamp, on, value, weight;
    Column density, choice;
    Columns2 numbers;
    Flags lobe;
};
template <class Seen>
struct Valuing {
    Points<Seen>& at;
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < lanes; ++i) {
            const BsdfValue found = at.columns.value(i, at.outgoing[i], at.to_lamp[i]);
            at.value.set(i, {found.value.r, found.value.g, found.value.b});
            at.density[i] = found.pdf;
        }
    }
};
template <class Seen>
struct Proposing {
    Points<Seen>& at;
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < lanes; ++i) {
            const Proposal way = at.columns[i].template propose<true>(at.outgoing[i], at.choice[i], at.numbers[i]);
            at.on.set(i, way.incoming);
            at.lobe[i] = way.lobe;
        }
    }
};
template <class Seen>
struct Weighing {
    Points<Seen>& at;
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < lanes; ++i) {
            const BsdfValue found = at.columns.value(i, at.outgoing[i], at.on[i]);
            const Rgb weight = found.value / found.pdf;
            at.weight.set(i, {weight.r, weight.g, weight.b});
        }
    }
};

template <class Seen>
void work_on_many(Points<Seen>& at) {
    for (std::size_t i = 0; i < lanes; ++i) at.columns.see(i, at.outgoing.z[i], lobe::all);
    for (std::size_t i = 0; i < lanes; ++i) at.columns.arrive(i, at.to_lamp.z[i]);
    Valuing<Seen> valuing{at};
    work_in_lanes(valuing);
    Proposing<Seen> proposing{at};
    work_in_lanes(proposing);
    for (std::size_t i = 0; i < lanes; ++i) at.columns.arrive(i, at.on.z[i]);
    Weighing<Seen> weighing{at};
    work_in_lanes(weighing);
}

template <class Seen>
void work_on_each(const Points<Seen>& at, std::vector<BsdfValue>& values,
                  std::vector<std::optional<BsdfSample>>& samples) {
    for (std::size_t i = 0; i < lanes; ++i) {
        values[i] = at.models[i].evaluate(at.outgoing[i], at.to_lamp[i], lobe::all);
        samples[i] = at.models[i].sample(at.outgoing[i], at.choice[i], at.numbers[i], lobe::all);
    }
}

template <class Seen, class Make>
void row(const std::string& name, const Make& make) {
    Points<Seen> at;
    for (std::uint32_t i = 0; i < lanes; ++i) {
        Samples samples(3, i);
        at.models.push_back(make(samples));
        at.columns.set(i, at.models.back());
        at.outgoing.set(i, cosine_hemisphere(samples.next_2d()));
        at.to_lamp.set(i, cosine_hemisphere(samples.next_2d()));
        at.numbers.set(i, samples.next_2d());
        at.choice[i] = samples.next();
    }
    std::vector<BsdfValue> values(lanes);
    std::vector<std::optional<BsdfSample>> samples(lanes);
    std::vector<double> parts;
    for (int turn = 0; turn < turns; ++turn) {
        const double begun = thread_seconds();
        for (int round = 0; round < rounds; ++round) work_on_many(at);
        const double many = thread_seconds();
        for (int round = 0; round < rounds; ++round) work_on_each(at, values, samples);
        parts.push_back((many - begun) / (thread_seconds() - many));
    }
    for (std::size_t i = 0; i < lanes; ++i) {
        const bool alike =
            values[i].pdf == at.density[i] && values[i].value.r == at.value.x[i] &&
            (!samples[i] || (samples[i]->incoming == at.on[i] && samples[i]->weight.r == at.weight.x[i]));
        if (!alike) throw std::runtime_error(name + ": a point among many is another than alone");
    }
    figure("shading." + name, parts, most, false);
}

void measure() {
    const Coat coat(1.5f, {{0.3f, 0.3f}});
    const auto colour = [](Samples& samples) {
        const Vec2 two = samples.next_2d();
        return Rgb{two.x, two.y, samples.next()};
    };
    row<SeenCoatedDiffuse<GgxLaw>>("coated", [&](Samples& samples) {
        return CoatedDiffuseBsdf{colour(samples), &coat, {0.3f, 0.3f}};
    });
    row<SeenConductor<GgxLaw>>("metal", [&](Samples& samples) {
        return ConductorBsdf{{0.2f, 0.9f, 1.2f}, {3, 2, 2}, {0.2f, 0.3f}, colour(samples)};
    });
    row<SeenPrincipled>("principled", [&](Samples& samples) {
        PrincipledBsdf model;
        model.base = colour(samples);
        model.metallic = 0.2f;
        model.facets = {0.3f, 0.3f};
        model.f0 = {0.04f, 0.04f, 0.04f};
        return model;
    });
}

}  // namespace
}  // namespace lightnet::bench

int main() { return lightnet::bench::run("shading", lightnet::bench::measure); }
