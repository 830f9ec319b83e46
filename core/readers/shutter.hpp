// Scenes that move while a shutter is open.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/scene/data/scene_data.hpp"

namespace lightnet {

/// The scene as it is when the shutter opens, with its motion until it closes. `read_at` gives the scene at a time. It
/// is asked at the ends, and half-way, again and again until each thing between two steps is within a thousandth of
/// its size of where a straight way would have it, in up to 32 parts. What has other parts at other times stands still,
/// and so do colours and brightness of what is no point or spot light, and suns: warnings say so.
SceneData read_in_shutter(const std::function<SceneData(double seconds)>& read_at, const ShutterSpan& shutter,
                          const std::string& file);

/// A scene in one frame of a sequence of files, and in those beside it, if they are there.
struct FramesAround {
    SceneData now;
    std::optional<SceneData> previous{}, next{};
};

/// The scene of the middle one as read_in_shutter() gives it, on straight ways between the frames. `shutter`: in frames
/// after that one, from -1 to 1.
SceneData blurred_between(const FramesAround& frames, const ShutterSpan& shutter, const std::string& file);

}  // namespace lightnet
