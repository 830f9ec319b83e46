// The table of who may say what at a door that asks for keys: one for all doors.
#pragma once

#include "transport/wire/packet.hpp"

namespace lightnet {

/// Who somebody is, by his key, to whom he talks.
enum class Party {
    stranger,  // whose key is not known: does not even get in
    // at the door of a host
    launcher,  // on its list, and not the one whose run it serves
    owner,     // began the run that it serves
    member,    // another host of that run
    // at the door of a launcher
    host,  // on its list
    user   // has the launcher's own key
};

bool may(Party party, packet::Type type);

}  // namespace lightnet
