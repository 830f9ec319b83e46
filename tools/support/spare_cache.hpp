// A cache where the usual one can't be had: in containers there may be no home that can be written.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/base/temporary_folder.hpp"

namespace lightnet {

using SpareCache = TemporaryFolder;

/// "": the usual folder of caches is there, and can be written. Else makes `spare`, says so, and returns its path.
/// `who_keeps`: "this daemon keeps", for what it says.
std::string cache_or_spare(std::optional<SpareCache>& spare, const std::string& who_keeps,
                           const std::function<void(const std::string&)>& say);

}  // namespace lightnet
