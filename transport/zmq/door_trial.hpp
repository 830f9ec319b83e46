// A trial of whether a door that asks for keys does so.
#pragma once

#include <functional>
#include <string>

#include "transport/keys/key.hpp"

namespace lightnet {

/// Knocks at `endpoint`, whose key is `door`, with a key that nobody knows, while `tend` does what its owner does.
/// Throws Error unless it is turned away: a library or a rule that lets strangers in is to be found by its owner first.
void try_door(const std::string& endpoint, const PublicKey& door, const std::function<void()>& tend);

}  // namespace lightnet
