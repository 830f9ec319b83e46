// Hosts, places and lines of a run that is foreseen, behind the carrier of a real MasterRenderer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/run/forecast/simulated_place.hpp"
#include "core/run/message/carrier.hpp"

namespace lightnet {

/// What a picture is rendered with, and how. `plan` names hosts by their names; "": the launcher's process.
struct SimulatedSetting {
    const RunCosts& costs;
    const Plan& plan;
    const std::vector<ForecastHost>& hosts;
    LineCost launcher;       // its line, which all share
    std::uint64_t seed = 1;  // of what pieces of the picture cost
};

/// Waiting makes time pass. One thread's.
class SimulatedCluster final : public Carrier {
public:
    explicit SimulatedCluster(SimulatedSetting setting);

    /// Seconds, as the launcher sees them.
    double now() const { return now_; }
    /// At that time the launcher hears of a plan.
    void announce(double time, Plan plan);
    bool ask(const PlaceAt& to, Message& message) override;
    void reply(Message) override {}
    std::optional<Message> receive() override;
    void wait(std::chrono::nanoseconds most) override;
    void forget(const PlaceAt&) override {}
    std::uint64_t pulse(const std::string&) const override { return ++pulse_; }
    const Counters& counters() const override { return counters_; }

    /// Seconds of work by node, at the speed of who did it; and of each place of the plan.
    std::vector<double> work_by_node() const;
    std::vector<double> work_by_place() const;
    /// Seconds in which the launcher's thread and line worked, and the line of each host: the way that was busier.
    double launcher_thread() const { return launcher_busy_; }
    double launcher_line() const { return std::max(launcher_out_.busy(), launcher_in_.busy()); }
    std::vector<double> host_lines() const;

private:
    struct Host {
        const ForecastHost* facts = nullptr;
        std::unique_ptr<SharedProcessors> processors{};
        std::map<std::uint32_t, std::size_t> places{};                      // by index: which of the plan
        std::map<std::size_t, std::unique_ptr<SimulatedReplicas>> desks{};  // by node: deals to its places
        SimulatedLine in{}, out{};
    };
    void make_hosts();
    void make_places();
    void connect(std::size_t place, std::size_t node);
    SimulatedReplicas& desk(Host& host, std::size_t node);
    void take_at(Host& host, std::optional<std::uint32_t> index, SimulatedAsk ask);
    void carry(Host& from, Host& to, double bytes, EventQueue::Happens happens);
    static bool is_own(const Host& host) { return host.facts->name.empty(); }
    double way_to(const Host& host) const { return host.facts->line.seconds + setting_.launcher.seconds; }
    void come_back(Host& host, double bytes, std::size_t colours, Message answer);
    SimulatedAsk work_in_tiles(const std::vector<Tile>& tiles) const;
    double times_of(const Tile& tile) const;
    double bytes_of(std::size_t node) const;

    SimulatedSetting setting_;
    PlaceKinds kinds_;
    EventQueue events_;
    std::unordered_map<std::string, Host> hosts_;
    std::vector<std::unique_ptr<SimulatedPlace>> places_;
    std::vector<double> times_;  // of pieces of the picture: some thousand, by what they weigh
    SimulatedLine launcher_out_, launcher_in_;
    std::deque<Message> arrived_;
    double now_ = 0, launcher_busy_ = 0;
    mutable std::uint64_t pulse_ = 0;
    Counters counters_;
};

}  // namespace lightnet
