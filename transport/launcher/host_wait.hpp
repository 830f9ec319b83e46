// The wait for hosts before the work begins, and for those that it begins without.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/launcher/host_patience.hpp"

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

    HostWait(HostPatience patience, Time begun) : patience_(patience), begun_(begun), next_words_(begun + first_) {}
    Verdict look(const Standing& standing, Time now);
    /// Is it time to say what is waited for? Less and less often: who waits for an hour doesn't want a thousand lines.
    bool should_speak(Time now);

private:
    static constexpr std::chrono::seconds first_{2}, longest_{60};
    HostPatience patience_;
    Time begun_, next_words_;
    std::chrono::seconds pause_{5};
    std::optional<Time> first_ready_;
};

/// Hosts that are not ready when the work begins: whether they may still come, and whether it ends without them. Time
/// is an argument.
class ExpectedHosts {
public:
    using Time = HostWait::Time;

    /// Those that don't answer are expected for twice as long as the work waits for them.
    void begin(HostPatience patience, Time begun) {
        greeted_by_ = begun + patience.absent;
        here_by_ = begun + 2 * patience.absent;
    }
    /// Nobody begins before all that answer are greeted: places make their nodes by the first plan.
    bool hold(Time now) const { return now < greeted_by_; }
    bool may_come(const HostWait::Standing& standing, Time now) const {
        return standing.pending || (standing.absent && now < here_by_);
    }
    /// The only host that was ready is taken out, while others may come.
    void wait_for_others(const std::string& why) { why_ = why; }
    bool waited_for() const { return why_.has_value(); }
    /// Throws Error, with why the last one was taken out, when nobody has come: it may be the run's own trouble.
    void look(const HostWait::Standing& standing, Time now);

private:
    Time greeted_by_{}, here_by_{};
    std::optional<std::string> why_;
};

/// One host that can't do its part may be sick. What two hosts say in the same words is the run's own trouble, and so
/// is what keeps the only ones from serving (`nobody_left`). Throws Error then.
void throw_if_broken(const std::vector<std::unique_ptr<HostLink>>& links, bool nobody_left);

}  // namespace lightnet
