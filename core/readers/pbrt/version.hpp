// The version of pbrt that a file was written for: all share their syntax, and say different things in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/readers/files/files.hpp"

namespace lightnet::pbrt {

/// Files of versions 1 and 2 are read as those of version 3, of which they are nearly all a part.
enum class Version { v3, v4 };

/// What tells a version.
struct VersionSign {
    Version version = Version::v4;
    SourceLine where;
    std::string text;  // "Film 'image'"
};

/// The first thing in the file that only one of the versions says. None: there is nothing of the kind. The names of the
/// files that it includes before that are added to `included`.
std::optional<VersionSign> version_sign(const std::string& file, const Bytes& bytes,
                                        std::vector<std::string>& included);

}  // namespace lightnet::pbrt
