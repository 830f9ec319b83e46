// The port by which a simulated place asks a node that is elsewhere, or that others answer as well.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "core/run/forecast/simulated_replicas.hpp"

namespace lightnet {

/// Gathers questions into bundles by the rules of BundlePort; where others relieve its place, by those of relief.
class SimulatedPort {
public:
    struct Target {
        std::size_t node = 0;
        double own_seconds = 0;  // of a question that this place answers itself; 0: it does not
        std::size_t helpers = 0;
        bool asks_on = false;                 // the node
        std::function<void()> heard = [] {};  // an answer has come: the place may go on
    };
    SimulatedPort(EventQueue& events, Target target, Strategy strategy, SimulatedReplicas::Send send);

    SimulatedReplicas& replicas() { return replicas_; }
    /// So many questions, of which parts may be left for the next time. False: none was due now, and `answered` is not
    /// called.
    bool ask(double questions, std::function<void()> answered);
    /// Sends what is due. `idle`: the place has nothing else to do.
    void flush(bool idle);
    /// Some of what waits for helpers, that this place answers itself.
    std::optional<SimulatedAsk> take_own();

private:
    struct Ask {
        std::size_t left;
        std::function<void()> answered;
    };
    struct Part {
        std::shared_ptr<Ask> ask;
        std::size_t questions;
    };
    SimulatedAsk take(std::size_t questions);
    void send(std::size_t questions);
    void share_out();
    std::size_t full() const;

    EventQueue& events_;
    Target target_;
    SimulatedReplicas replicas_;
    std::deque<Part> parts_;
    std::size_t waiting_ = 0, own_ = 0;
    double carried_ = 0;  // a part of a question
    double oldest_ = 0;   // when it came
    double faded_ = 0;    // when helpers were last thought to be quicker than they were
};

}  // namespace lightnet
