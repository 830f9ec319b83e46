// The wait for hosts before the work begins.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "transport/launcher/cluster.hpp"

namespace lightnet {

class HostLink;

/// Looks at how hosts stand from time to time, and decides. Time is an argument.
class HostWait {
public:
    using Time = std::chrono::steady_clock::time_point;
    /// Of all hosts together: is one ready, does one take the job in, is one that was named not there, does one serve
    /// another run? And may others come that nobody has named? Do files arrive somewhere, however slowly?
    struct Standing {
        bool ready = false, pending = false, absent = false, busy = false, others_may_come = false;
        bool files_arrive = false;
    };
    enum class Verdict { wait, begin, nobody, nobody_free };

    HostWait(Cluster::Patience patience, Time begun)
        : patience_(patience), begun_(begun), next_words_(begun + first_) {}
    Verdict look(const Standing& standing, Time now);
    /// Is it time to say what is waited for? Less and less often: who waits for an hour doesn't want a thousand lines.
    bool should_speak(Time now);

private:
    static constexpr std::chrono::seconds first_{2}, longest_{60};
    Cluster::Patience patience_;
    Time begun_, next_words_;
    std::chrono::seconds pause_{5};
    std::optional<Time> first_ready_;
};

/// One host that can't do its part may be sick. What two hosts say in the same words is the run's own trouble, and so
/// is what keeps the only ones from serving (`nobody_left`). Throws Error then.
void throw_if_broken(const std::vector<std::unique_ptr<HostLink>>& links, bool nobody_left);

}  // namespace lightnet
