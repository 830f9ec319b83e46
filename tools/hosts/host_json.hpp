// The output of `lightnet hosts --json`.
#pragma once

#include <string>
#include <vector>

#include "transport/launcher/ask_state.hpp"

namespace lightnet {

/// As docs/schemas/hosts.schema.json has it. `joining`: names of those that join by themselves, and can't be asked;
/// `build`: ours.
std::string host_json(const std::vector<HostAnswer>& hosts, const std::vector<std::string>& joining,
                      const std::string& build);

}  // namespace lightnet
