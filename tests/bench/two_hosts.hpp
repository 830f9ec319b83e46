// Two daemons in threads of the benchmark, and the launcher's way to them.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "tests/bench/picture.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet::bench {

/// One place on each of two hosts, asked over tcp.
class TwoHosts {
public:
    /// `plan` says what their places hold.
    TwoHosts(const Registry& kinds, const Picture& picture, std::uint64_t run, Job job,
             const std::function<Plan(const PlaceAt&, const PlaceAt&)>& plan)
        : TwoHosts(kinds, picture, run, std::move(job), plan, std::nullopt) {}
    /// All know each other by this key.
    TwoHosts(const Registry& kinds, const Picture& picture, std::uint64_t run, Job job,
             const std::function<Plan(const PlaceAt&, const PlaceAt&)>& plan, const std::optional<KeyPair>& key)
        : first_(kinds, host_options(key)),
          second_(kinds, host_options(key)),
          cluster_(options(picture, run, std::move(job), plan, key)) {
        const std::atomic<bool> never{false};
        cluster_.gather(std::chrono::seconds(5), never);
        cluster_.adopt(cluster_.plan());
    }
    Cluster& cluster() { return cluster_; }

private:
    static Host::Options host_options(const std::optional<KeyPair>& key) {
        Host::Options options;
        options.places = 1;
        options.key = key;
        if (key) options.allow = key->open.text();
        return options;
    }
    Cluster::Options options(const Picture& picture, std::uint64_t run, Job job,
                             const std::function<Plan(const PlaceAt&, const PlaceAt&)>& plan,
                             const std::optional<KeyPair>& key) const {
        Cluster::Options options;
        options.key = key;
        if (key) options.host_keys = {{first_.endpoint(), key->open}, {second_.endpoint(), key->open}};
        options.run = run;
        options.job = std::move(job);
        options.files = picture.files;
        options.endpoints = {first_.endpoint(), second_.endpoint()};
        options.plan = [whole = plan({first_.endpoint(), 0}, {second_.endpoint(), 0})](const std::vector<HostOffer>&) {
            return whole;
        };
        return options;
    }

    test::HostThread first_, second_;
    Cluster cluster_;
};

}  // namespace lightnet::bench
