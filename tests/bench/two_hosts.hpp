// Two daemons in threads of the benchmark, and the launcher's way to them.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
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
        : first_(kinds), second_(kinds), cluster_(options(picture, run, std::move(job), plan)) {
        const std::atomic<bool> never{false};
        cluster_.gather(std::chrono::seconds(5), never);
        cluster_.adopt(cluster_.plan());
    }
    Cluster& cluster() { return cluster_; }

private:
    Cluster::Options options(const Picture& picture, std::uint64_t run, Job job,
                             const std::function<Plan(const PlaceAt&, const PlaceAt&)>& plan) const {
        Cluster::Options options;
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
