// A job that has come to a host and is being read.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <string>

#include "core/network/graph/plan.hpp"
#include "core/run/assembly/job.hpp"
#include "transport/keys/allow_list.hpp"

namespace lightnet {

/// Somebody who has sent a packet: how to answer, and his key as text.
struct PacketSender {
    std::string route, key;
};

/// In the background: whoever sent it may be nobody's friend.
struct ArrivingJob {
    /// As it was read.
    struct Content {
        Job job;
        Plan plan;
    };
    std::uint64_t id = 0;
    PacketSender sender;
    std::string you, who;  // as the launcher calls this host, and itself
    AllowList members;     // of the run
    std::string numbers;   // where its hosts are that have names
    std::future<Content> content;

    bool is_read() const { return content.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
};

}  // namespace lightnet
