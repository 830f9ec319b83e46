// Light's way straight through panes of glass, to points that look for it.
#pragma once

#include <cstdint>
#include <span>

#include "core/estimate/shadow_rays.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {

/// Are there panes of glass? Where there are none, nobody needs to ask what follows.
bool has_panes(const Scene& scene);
/// Takes from the light of shadow rays what panes keep of it, and tells those that nothing else is in the way of from
/// the `occluded`. `only`: what comes through no pane is occluded as well.
void pass_through_panes(const Scene& scene, bool only, std::span<std::uint8_t> occluded, ShadowRays& rays);

}  // namespace lightnet
