// What users are told of their mistakes.
#pragma once

#include <string>

#include "core/base/error.hpp"

namespace lightnet::test {

/// The text of the UserError that `act` throws; "": it throws none.
template <class Act>
std::string mistake_of(const Act& act) {
    try {
        act();
        return "";
    } catch (const UserError& error) {
        return error.what();
    }
}

}  // namespace lightnet::test
