// Profiles of luminaires for lamps of a scene whose file has none of them.
#pragma once

#include <optional>
#include <span>

#include "core/readers/overrides.hpp"

namespace lightnet {

/// Points and spots of these names shine by the profiles: times their own intensity, a candela being 1 W/sr. Straight
/// down is where a spot points; of a point it is `down` (unit, world space), else -z of its own axes in the file. Opens
/// files only through `files`. Throws UserError with all that is wrong, which names `where`.
void put_profiles(std::span<const ProfileOverride> profiles, const std::optional<Vec3>& down, SceneData& scene,
                  Files& files, const SourceLine& where);

}  // namespace lightnet
