#include "core/scene/media/flight.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/math/exponential.hpp"
#include "core/scene/media/bounds.hpp"
#include "core/scene/media/medium.hpp"
#include "core/scene/media/stretches.hpp"

namespace lightnet {
namespace {

Key bits(float a, float b) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b);
}

float sum(Rgb c) { return c.r + c.g + c.b; }
Rgb each(Rgb c, auto&& of) { return {of(c.r), of(c.g), of(c.b)}; }
Rgb over(Rgb a, float b) { return b > 0 ? a / b : Rgb{}; }

// Beer and Lambert's law; nothing collides with what does not, however far it goes.
float left(float extinction, float distance) { return extinction > 0 ? exponential(-extinction * distance) : 1; }
Rgb left(Rgb extinction, float distance) {
    return each(extinction, [&](float one) { return left(one, distance); });
}

// That are to be expected in one cell: whoever writes a denser medium gets one of this density.
constexpr float most_steps = 4096;

// A distance over the mean free path.
float free_path(float u) { return -logarithm(1 - u); }

// take(distance, most) of each place where light may collide, by bounds `most` of the extinction, in order, until it
// says false. Returns what it said last.
template <class Take>
bool each_tentative(const CollisionBounds& bounds, const Ray& ray, const Stretch& way, FlightNumbers& numbers,
                    Take&& take) {
    return bounds.each_cell(ray, way.begin, way.end, [&](float begin, float end, float most) {
        if (!(most > 0)) return true;
        most = std::min(most, most_steps / (end - begin));
        while (true) {
            begin += free_path(numbers.next()) / most;
            if (!(begin < end)) return true;
            if (!take(begin, most)) return false;
        }
    });
}

// Chances of the colours, by what a path carries of each.
Rgb chances(Rgb carried) {
    const float all = sum(carried);
    return all > 0 && std::isfinite(all) ? carried / all : Rgb{1, 1, 1} / 3;
}
float chosen(Rgb chances, Rgb of, float u) {
    if (u < chances.r) return of.r;
    return u < chances.r + chances.g || chances.b == 0 ? of.g : of.b;
}

// What comes from all of a stretch, and arrives at its beginning: ∫ emission × exp(-extinction t) dt.
float emitted_along(float emission, float extinction, float length) {
    if (emission == 0) return 0;
    const float depth = extinction * length;
    if (depth < 1e-3f) return emission * length * (1 - depth / 2);
    return emission * (1 - exponential(-depth)) / extinction;
}

}  // namespace

FlightNumbers::FlightNumbers(const Ray& ray, Vec2 first)
    : first_(first),
      key_(child(
          child(child(bits(first.x, first.y), bits(ray.origin.x, ray.origin.y)), bits(ray.origin.z, ray.direction.x)),
          bits(ray.direction.y, ray.direction.z))) {}

float FlightNumbers::next() {
    const std::uint32_t number = used_++;
    if (number < 2) return number == 0 ? first_.x : first_.y;
    return float(child(key_, number) >> 40) * 0x1p-24f;
}

bool fly_even(const Medium& medium, const Stretch& way, Rgb carried, FlightNumbers& numbers, Flight& flight) {
    const Rgb extinction = medium.extinction.value, emission = medium.emission.value;
    const float length = way.end - way.begin;
    const Rgb shine{emitted_along(emission.r, extinction.r, length), emitted_along(emission.g, extinction.g, length),
                    emitted_along(emission.b, extinction.b, length)};
    if (!is_black(emission)) flight.emitted += flight.weight * shine;
    if (is_black(medium.albedo.value)) {  // nothing to be gained by a collision
        flight.weight *= left(extinction, length);
        return true;
    }
    const Rgb chance = chances(carried * flight.weight);
    const float exponent = free_path(numbers.next()), one = chosen(chance, extinction, numbers.next());
    const float free = one > 0 ? exponent / one : std::numeric_limits<float>::infinity();
    const bool collides = free < length;
    Rgb density = left(extinction, collides ? free : length);
    if (collides) {
        density *= extinction;
        flight.collision = Collision{way.begin + free, way.medium};
    }
    flight.weight *= over(density, sum(chance * density));
    return !collides;
}

bool fly_uneven(const Medium& medium, const CollisionBounds& bounds, const Ray& ray, const Stretch& way, Rgb carried,
                FlightNumbers& numbers, Flight& flight) {
    const bool scatters = medium.albedo.grid || !is_black(medium.albedo.value);
    return each_tentative(bounds, ray, way, numbers, [&](float distance, float most) {
        const Vec3 place = ray.origin + ray.direction * distance;
        const Rgb share = medium.extinction.at(place) / most;  // of collisions that are real
        flight.emitted += flight.weight * medium.emission.at(place) / most;
        // DECISIONS: colours-collide-together
        // Colours collide together, with the chance that suits what is carried of them: Kutz et al. 2017, "Spectral
        // and Decomposition Tracking for Rendering Heterogeneous Volumes".
        const float real = scatters ? std::min(sum(chances(carried * flight.weight) * share), 1.0f) : 0;
        if (numbers.next() < real) {
            flight.weight *= over(share, real);
            flight.collision = Collision{distance, way.medium};
            return false;
        }
        flight.weight *= over(each(share, [](float one) { return std::max(0.0f, 1 - one); }), 1 - real);
        return !is_black(flight.weight);
    });
}

Rgb left_along(const Medium& medium, float length) { return left(medium.extinction.value, length); }

bool let_through(const Medium& medium, const CollisionBounds& bounds, const Ray& ray, const Stretch& way,
                 FlightNumbers& numbers, Rgb& light) {
    constexpr float faint = 0.05f, ends = 0.75f;  // Russian roulette, as all that follows is for little
    return each_tentative(bounds, ray, way, numbers, [&](float distance, float most) {
        const Rgb share = medium.extinction.at(ray.origin + ray.direction * distance) / most;
        light *= each(share, [](float one) { return std::max(0.0f, 1 - one); });
        if (max_component(light) < faint) {
            if (numbers.next() < ends) light = {};
            light *= 1 / (1 - ends);
        }
        return !is_black(light);
    });
}

}  // namespace lightnet
