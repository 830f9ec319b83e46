// Looks whether this machine, and others, are fit for runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/launcher/probe_hosts.hpp"

namespace lightnet {

/// Something that was looked at: how it is, and what to do about it ("": nothing).
struct Finding {
    enum class Grade { good, doubtful, bad };
    Grade grade = Grade::good;
    std::string about, what, advice;
    friend bool operator==(const Finding&, const Finding&) = default;
};

/// Of this machine. Touches nothing but the cache's folder, which it makes if there is none.
std::vector<Finding> look_at_this_machine(const std::string& cache);
/// Of others, beside this one's build.
std::vector<Finding> look_at_hosts(const std::vector<HostProbe>& probes, const std::string& build);

/// In what two names of builds differ: "compiler 12.2.0, here 13.1.0". "": in nothing.
std::string difference_of_builds(const std::string& theirs, const std::string& ours);

std::string findings_table(const std::vector<Finding>& findings);
bool all_good_enough(const std::vector<Finding>& findings);

}  // namespace lightnet
