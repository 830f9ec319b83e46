// Members of a glTF file that nobody has asked for.
#pragma once

#include "core/readers/gltf/json.hpp"

namespace lightnet::gltf {

/// Warns of each member, by its path without numbers, that was not read of an object that was; but for those that no
/// picture shows. What nothing in the scene uses is not looked at.
void warn_of_unread(const Json& document, const Seen& seen, const SourceLine& where, Report& report);

}  // namespace lightnet::gltf
