// Profiles of luminaires: how much light goes where, as makers of lamps publish it (.ies).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/readers/common/lamp_tilt.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// Candela by angles, linear between those that were measured. In the luminaire's own axes the angles 0, 0 lie at -z
/// (straight down, of most), and horizontal angles turn from +x to +y, as glTF's EXT_lights_ies has it.
struct LightProfile {
    enum class Photometry {
        c = 1,  // vertical: from -z up to +z; horizontal: around z
        b = 2,  // horizontal: from the middle plane along x; vertical: around x
        a = 3   // vertical: from the middle plane along y; horizontal: around y
    } photometry = Photometry::c;
    std::vector<float> vertical,
        horizontal;              // degrees, ascending; over a part of the circle: the rest is its mirror image
    std::vector<float> candela;  // all vertical angles of the first horizontal one, and so on
    LampTilt tilt;               // not in the candelas
    std::string tilt_missing;    // the file that has it, and that can't be had; "": none

    /// Candela towards `direction` (unit); 0 where nothing was measured.
    float towards(Vec3 direction) const;
};

/// The text of the file that a profile names for its factors of tilt ("TILT=lamp.tlt"); none: it can't be had.
using TiltFile = std::function<std::optional<std::string>(const std::string& name)>;

/// Reads IESNA LM-63 of 1986, 1991, 1995, 2002 and 2019. Throws Error, without a file name, where it is not sound.
LightProfile read_light_profile(std::string_view text, const TiltFile& tilt_file = {});

/// What a picture lacks of how the lamp's light changes as it is tilted; "": nothing. `up_known`: something says where
/// down is.
std::string lacks_of_tilt(const LightProfile& profile, bool up_known);

/// What a point light with that profile and an intensity of 1 shines by; `to_world` turns the luminaire's own axes.
EnvironmentData pattern_of(const LightProfile& profile, const Matrix& to_world);

}  // namespace lightnet
