#include "nodes/examples/candela/candela.hpp"

#include <algorithm>
#include <cmath>

namespace candela {
namespace {

const double pi = 3.14159265358979323846;

Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator*(const Vec& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(const Vec& a, const Vec& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec unit(const Vec& a) { return a * (1 / std::sqrt(dot(a, a))); }

Colour operator*(const Colour& a, const Colour& b) { return {a.red * b.red, a.green * b.green, a.blue * b.blue}; }
Colour operator*(const Colour& a, double s) { return {a.red * s, a.green * s, a.blue * s}; }
void operator+=(Colour& a, const Colour& b) { a = {a.red + b.red, a.green + b.green, a.blue + b.blue}; }
bool black(const Colour& a) { return a.red == 0 && a.green == 0 && a.blue == 0; }

// Around the normal, denser where it counts more.
Vec scattered(const Spot& spot, double first, double second) {
    const Vec other = std::fabs(spot.normal.x) > 0.5 ? Vec{0, 1, 0} : Vec{1, 0, 0};
    const Vec right = unit(cross(other, spot.normal)), up = cross(spot.normal, right);
    const double radius = std::sqrt(first), turn = 2 * pi * second;
    const Vec flat = right * (radius * std::cos(turn)) + up * (radius * std::sin(turn));
    return flat + spot.normal * std::sqrt(std::max(0.0, 1 - radius * radius));
}

// L'Ecuyer 1999, "Tables of linear congruential generators", the multiplier for modulus 2^64.
double next_of(unsigned long long& state) {
    state = state * 3935559000370003845ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
}

unsigned long long chance_state = 1;

}  // namespace

void Dice::seed(unsigned long long seed) { state_ = seed; }
double Dice::roll() { return next_of(state_); }

void seed_chance(unsigned long long seed) { chance_state = seed; }
double chance() { return next_of(chance_state); }

Colour OpenGlow::glow(const Spot& spot, const Vec&) {
    int open = 0;
    for (int i = 0; i < rays_; ++i) {
        const double first = chance(), second = chance();
        if (!tracer_.blocked(spot.where, spot.where + scattered(spot, first, second) * near_)) ++open;
    }
    return spot.paint * (double(open) / rays_);
}

DirectGlow::DirectGlow(Tracer& tracer, Lamps& lamps, Dice& dice, int rays)
    : tracer_(tracer), lamps_(lamps), dice_(dice), rays_(rays) {}

Colour DirectGlow::glow(const Spot& spot, const Vec&) {
    Colour sum;
    for (int i = 0; i < rays_; ++i) {
        double numbers[3];
        for (double& number : numbers) number = dice_.roll();
        if (!lamps_.choose(spot.where, numbers, point_)) continue;
        const double slope = dot(point_.towards, spot.normal);
        if (slope <= 0 || tracer_.blocked(spot.where, point_.where)) continue;
        sum += spot.paint * point_.light * (slope / (pi * point_.density));
    }
    return sum * (1.0 / rays_);
}

GatheredGlow::GatheredGlow(Tracer& tracer, Glow& surroundings, Dice& dice, int rays)
    : tracer_(tracer), surroundings_(surroundings), dice_(dice), rays_(rays) {}

Colour GatheredGlow::glow(const Spot& spot, const Vec&) {
    sum_ = Colour();
    for (int i = 0; i < rays_; ++i) {
        const double first = dice_.roll(), second = dice_.roll();
        const Vec towards = scattered(spot, first, second);
        if (tracer_.nearest(spot.where, towards, seen_)) sum_ += surroundings_.glow(seen_, towards * -1);
    }
    return spot.paint * sum_ * (1.0 / rays_);
}

DimmedGlow::DimmedGlow(Glow& other, double strength, double limit)
    : other_(other), strength_(strength), limit_(limit) {}

Colour DimmedGlow::glow(const Spot& spot, const Vec& towards_eye) {
    const Colour bright = other_.glow(spot, towards_eye) * strength_;
    return {std::min(bright.red, limit_), std::min(bright.green, limit_), std::min(bright.blue, limit_)};
}

Eye::Eye(Tracer& tracer, Glow& glow, int most_mirrors) : tracer_(tracer), glow_(glow), most_mirrors_(most_mirrors) {}

Colour Eye::see(const Vec& from, const Vec& towards) {
    Spot spot;
    if (!tracer_.nearest(from, towards, spot)) return tracer_.sky(from, towards);
    Colour seen = spot.shine;
    if (!black(spot.paint)) seen += glow_.glow(spot, towards * -1);
    if (!black(spot.gloss) && mirrors_ < most_mirrors_) {
        ++mirrors_;
        const Vec mirrored = towards + spot.normal * (-2 * dot(towards, spot.normal));
        seen += spot.gloss * see(spot.where, mirrored);
        --mirrors_;
    }
    return seen;
}

}  // namespace candela
