// Light of lamps that changes with how they lie: discharge lamps, by LM-63's factors of tilt.
#pragma once

#include <vector>

#include "core/base/math/transform.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Factors by angles of the lamp from how it lies in a luminaire that hangs straight; none: always 1.
struct LampTilt {
    enum class Lamp {
        vertical = 1,          // its base is straight up or down
        stays_horizontal = 2,  // along y: it does not leave the horizontal where the luminaire turns through its
                               // vertical angles
        leaves_horizontal = 3  // along x: it does
    } lamp = Lamp::vertical;
    std::vector<float> angles, factors;  // degrees, ascending

    /// Of a luminaire with these axes in the world, whose own straight down is -z. `up`: unit, of the world.
    float factor(const Matrix& luminaire, Vec3 up) const;
    /// That of one that hangs straight.
    float straight() const { return at(0); }
    /// Does it matter how the luminaire hangs?
    bool varies() const;

private:
    float at(float degrees) const;
};

}  // namespace lightnet
