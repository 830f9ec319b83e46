// Where a picture is to go.
#pragma once

#include <string>

namespace lightnet {

/// Throws UserError when no picture can be written there: said before work starts, not after hours of it.
void check_output(const std::string& output);

}  // namespace lightnet
