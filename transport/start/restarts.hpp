// The delay before a worker that has died is started anew.
#pragma once

#include <chrono>

namespace lightnet {

/// Later and later, and not for ever: it is given up when it keeps dying before it was of use.
class Restarts {
public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr int most_useless_deaths = 5;

    void died(Time now, bool was_of_use) {
        useless_deaths_ = was_of_use ? 0 : useless_deaths_ + 1;
        next_start_ = now + first_delay * (1 << useless_deaths_);
    }
    void give_up() { useless_deaths_ = most_useless_deaths; }
    bool given_up() const { return useless_deaths_ >= most_useless_deaths; }
    /// Of one that is dead.
    bool due(Time now) const { return !given_up() && now >= next_start_; }

private:
    static constexpr auto first_delay = std::chrono::milliseconds(50);  // doubles

    int useless_deaths_ = 0;  // in a row
    Time next_start_{};
};

}  // namespace lightnet
