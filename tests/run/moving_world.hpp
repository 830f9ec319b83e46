// A world for movers: hosts that render by a layout, on a clock of its own, and what of it is measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/run/forecast/mover.hpp"
#include "core/run/forecast/place_work.hpp"

namespace lightnet::test {

/// Hosts share out the picture as they can; each operator is answered by those who hold it, in proportion to their
/// speed. What takes longest holds all others up.
class MovingWorld {
public:
    /// How quick a host is at a time, beside usual; the seed is that of what measuring adds.
    using Pace = std::function<double(std::size_t host, double now)>;
    MovingWorld(LaidOut by, Pace pace, double noise = 0, std::uint64_t seed = 1)
        : by_(by), pace_(std::move(pace)), noise_(noise), random_(seed), mover_(std::move(by)) {}

    struct Moved {
        double at;
        Move move;
    };

    /// Goes on, a window after the other, until the picture is done or `end` has come.
    void run(double end) {
        while (now_ < end && left_ > 0) step();
    }
    const std::vector<Moved>& moves() const { return moves_; }
    double now() const { return now_; }
    double left() const { return left_; }
    const Mover& mover() const { return mover_; }
    void lose(std::size_t host) { lost_.push_back(host); }
    /// Blocks a second, with these holders, now.
    double rate(const HeldByHosts& holds) const { return 1 / busy(holds).longest; }
    double rate() const { return rate(mover_.by().holds); }
    /// Seconds that a block takes in truth of each node, beside what was foreseen.
    std::vector<double> truth;

private:
    // Of one block: seconds of each host's places by node, and of the one that holds all up, of all its places.
    struct Busy {
        std::vector<std::vector<double>> by_host;
        double longest = 0;
    };

    bool there(std::size_t host) const { return std::find(lost_.begin(), lost_.end(), host) == lost_.end(); }
    double power(std::size_t host) const {
        return there(host) ? by_.hosts[host].places * by_.hosts[host].speed * pace_(host, now_) : 0;
    }

    // Operators first, where they are; then the picture, wherever there is time left.
    Busy busy(const HeldByHosts& holds) const {
        auto work = work_by_node(by_.costs);
        const double blocks = usual_blocks(by_.costs.picture);
        Busy all{std::vector(by_.hosts.size(), std::vector<double>(work.size(), 0)), 0};
        std::vector<double> used(by_.hosts.size(), 0);
        double sum = 0, powers = 0;
        for (std::size_t node = 0; node < work.size(); ++node) {
            work[node] *= (truth.empty() ? 1 : truth[node]) / blocks;
            sum += work[node];
            if (node == by_.costs.image) continue;
            double holders = 0;
            for (std::size_t host = 0; host < used.size(); ++host)
                if (holds[host][node]) holders += power(host);
            if (holders <= 0) all.longest = std::numeric_limits<double>::infinity();
            for (std::size_t host = 0; host < used.size() && holders > 0; ++host)
                if (holds[host][node]) {
                    used[host] += work[node] / holders;
                    all.by_host[host][node] = work[node] * power(host) / holders;
                }
        }
        for (std::size_t host = 0; host < used.size(); ++host) powers += power(host);
        for (const double seconds : used) all.longest = std::max(all.longest, seconds);
        all.longest = std::max(all.longest, sum / powers);
        double room = 0;
        for (std::size_t host = 0; host < used.size(); ++host) room += (all.longest - used[host]) * power(host);
        for (std::size_t host = 0; host < used.size() && room > 0; ++host)
            all.by_host[host][by_.costs.image] =
                work[by_.costs.image] * (all.longest - used[host]) * power(host) / room;
        return all;
    }

    double about(double value) { return value * std::exp(noise_ * std::normal_distribution<double>()(random_)); }

    void step() {
        const double window = 0.8;
        const auto all = busy(mover_.by().holds);
        const double blocks = window / all.longest, whole = usual_blocks(by_.costs.picture);
        RunWindow seen{{}, {}, about(blocks)};
        for (std::size_t host = 0; host < by_.hosts.size(); ++host) {
            HostWindow one{.there = there(host), .seconds = window, .busy = {}};
            const double most = power(host) * window;
            for (const double work : all.by_host[host]) {
                const double share = most > 0 ? std::min(1.0, about(work * blocks / most)) : 0;
                one.busy.push_back(share);
                one.processor += share * by_.hosts[host].places * window * about(pace_(host, now_));
            }
            seen.hosts.push_back(one);
        }
        const auto questions = questions_of_block(by_.costs);
        for (const auto& edge : by_.costs.edges)
            seen.questions.push_back(questions[edge.from] * edge.questions * blocks);
        now_ += window;
        left_ = std::max(0.0, left_ - blocks / whole);
        seen.left = left_;
        if (auto move = mover_.look(now_, seen)) moves_.push_back({now_, std::move(*move)});
    }

    LaidOut by_;
    Pace pace_;
    double noise_;
    std::mt19937_64 random_;
    Mover mover_;
    std::vector<Moved> moves_;
    std::vector<std::size_t> lost_;
    double now_ = 0, left_ = 1;
};

}  // namespace lightnet::test
