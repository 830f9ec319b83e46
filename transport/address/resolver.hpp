// Names of hosts become addresses, while nobody waits.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "transport/address/name_service.hpp"

namespace lightnet {

/// Looks names up in threads of its own, each name once at a time, and keeps the answers. Any thread.
// DECISIONS: names-are-ours
class Resolver {
public:
    using Time = std::chrono::steady_clock::time_point;
    explicit Resolver(std::shared_ptr<const NameService> service = system_names());
    /// Waits for nobody: a lookup that hangs is left to itself.
    ~Resolver();
    Resolver(const Resolver&) = delete;
    Resolver& operator=(const Resolver&) = delete;

    /// What is known of it by now. Asks when nothing is, and anew when what is known is older than `fresh`. Numbers and
    /// "localhost" are known without asking. Never waits.
    Whereabout look(const std::string& host, Time now, std::chrono::milliseconds fresh = std::chrono::hours(24));
    /// What is known of it once it is answered; gives up after so long.
    Whereabout wait_for(const std::string& host, std::chrono::milliseconds most);
    /// Of several addresses, the one that has answered last under this endpoint is called first the next time.
    void remember(const std::string& endpoint, const IpAddress& address);
    std::optional<IpAddress> remembered(const std::string& endpoint) const;

private:
    struct Desk;
    std::shared_ptr<Desk> desk_;  // lookups that hang outlive this object
};

}  // namespace lightnet
