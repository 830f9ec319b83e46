// Packets between a host's door and its places.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "transport/daemon/host_door.hpp"
#include "transport/daemon/host_rights.hpp"
#include "transport/lines/leadership.hpp"
#include "transport/zmq/zmq_place_transport.hpp"

namespace lightnet {

/// Takes asks from the door to the places of the run, and their replies back. Belongs to who leads.
class PlaceTraffic final : public Leadership::Led {
public:
    using Time = HostDoor::Time;
    /// What came, and the key of whom it came from, as text.
    struct Arrival {
        Frames frames;
        std::string key;
    };

    PlaceTraffic(HostDoor& door, HostRights& rights) : door_(door), rights_(rights) {}

    /// The run whose places serve from now on; null: none does.
    void serve(std::uint64_t run, ZmqPlaceTransport* transport);
    /// What has come for nobody but the host itself, if anything. For its own thread.
    std::optional<Arrival> receive(Time now);
    /// There is something that a place has left.
    bool has_left() const { return left_.has_value(); }
    /// An ask; it is dropped where its run is not served.
    void ask(const packet::Header& header, Frames frames);

    void watch(Poll& poll) const override { door_.watch(poll, HostDoor::Watched::messages); }
    bool take_in() override;
    void send() override;

    /// All asks so far are answered.
    bool is_idle() const { return answered_ >= given_; }
    /// Asks of the run.
    std::uint64_t given() const { return given_; }
    /// When the last came.
    Time last_work() const { return last_work_; }

private:
    bool take(Arrival& arrival);
    std::optional<Arrival> next(Time now);

    HostDoor& door_;
    HostRights& rights_;
    std::uint64_t run_ = 0;
    ZmqPlaceTransport* places_ = nullptr;
    std::optional<Arrival> left_;  // by a place, to the host's own thread
    std::uint64_t given_ = 0, answered_ = 0;
    Time last_work_{};
};

}  // namespace lightnet
