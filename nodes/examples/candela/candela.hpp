// Candela: a small lighting library of the traditional kind, as an example of code that lightnet wraps unchanged. One
// point at a time, virtual calls, members that change; it knows nothing of anything around it.
#pragma once

namespace candela {

struct Vec {
    double x = 0, y = 0, z = 0;
};

struct Colour {
    double red = 0, green = 0, blue = 0;
};

/// A point on some object, seen from somewhere.
struct Spot {
    Vec where;
    Vec normal;    // unit, on the side from which it is seen
    Colour paint;  // share of light that it scatters evenly
    Colour gloss;  // share of light that it mirrors
    Colour shine;  // light of its own, towards where it is seen from
};

/// The world, as rays see it.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// What does the ray meet first, beside what it starts on? False: nothing.
    virtual bool nearest(const Vec& from, const Vec& towards, Spot& spot) = 0;
    /// Is anything in between?
    virtual bool blocked(const Vec& from, const Vec& to) = 0;
    /// Light from where nothing is.
    virtual Colour sky(const Vec& from, const Vec& towards) = 0;
};

/// A point of a lamp, as it lights a spot.
struct LampPoint {
    Vec where;
    Vec towards;         // unit, from the spot
    Colour light;        // that arrives if nothing is in between
    double density = 0;  // of having chosen it, per steradian
};

class Lamps {
public:
    virtual ~Lamps() = default;
    /// Chooses a point by three numbers in [0,1). False: no lamp for these.
    virtual bool choose(const Vec& seen_from, const double (&numbers)[3], LampPoint& point) = 0;
};

/// Anything that says how bright a spot is.
class Glow {
public:
    virtual ~Glow() = default;
    virtual Colour glow(const Spot& spot, const Vec& towards_eye) = 0;
};

/// Random numbers: the same ones for the same seed.
class Dice {
public:
    void seed(unsigned long long seed);
    double roll();

private:
    unsigned long long state_ = 1;
};

/// Numbers by chance, as the oldest parts of the library draw them: one sequence for all of a program.
void seed_chance(unsigned long long seed);
double chance();

/// How bright a spot would be if light came from all around, and only what is near kept it off.
class OpenGlow : public Glow {
public:
    OpenGlow(Tracer& tracer, int rays, double near) : tracer_(tracer), rays_(rays), near_(near) {}
    Colour glow(const Spot& spot, const Vec& towards_eye) override;

private:
    Tracer& tracer_;
    int rays_;
    double near_;
};

/// Light that comes straight from lamps.
class DirectGlow : public Glow {
public:
    DirectGlow(Tracer& tracer, Lamps& lamps, Dice& dice, int rays);
    Colour glow(const Spot& spot, const Vec& towards_eye) override;

private:
    Tracer& tracer_;
    Lamps& lamps_;
    Dice& dice_;
    int rays_;
    LampPoint point_;  // the last one chosen
};

/// Light that others have scattered once more: asks how bright the surroundings are, one spot after the other.
class GatheredGlow : public Glow {
public:
    GatheredGlow(Tracer& tracer, Glow& surroundings, Dice& dice, int rays);
    Colour glow(const Spot& spot, const Vec& towards_eye) override;

private:
    Tracer& tracer_;
    Glow& surroundings_;
    Dice& dice_;
    int rays_;
    Spot seen_;  // the last one met
    Colour sum_;
};

/// Another glow, fainter or brighter, and not beyond a limit.
class DimmedGlow : public Glow {
public:
    DimmedGlow(Glow& other, double strength, double limit);
    Colour glow(const Spot& spot, const Vec& towards_eye) override;

private:
    Glow& other_;
    double strength_, limit_;
};

/// Follows one ray from the eye, through mirrors, and asks how bright is what it meets.
class Eye {
public:
    Eye(Tracer& tracer, Glow& glow, int most_mirrors);
    Colour see(const Vec& from, const Vec& towards);

private:
    Tracer& tracer_;
    Glow& glow_;
    int most_mirrors_;
    int mirrors_ = 0;  // on the way to what is looked at now
};

}  // namespace candela
