// A graph of graphs/ that is prepared and rendered over and over: on places in threads, or on hosts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/prepared.hpp"
#include "core/run/message/carrier.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet::bench {

/// One rendering: its picture, and what it took.
struct Rendered {
    lightnet::Picture picture;          // benchmarks have another one
    double building = 0;                // seconds until the scene is read and its tree built
    double preparing = 0, seconds = 0;  // after that; the latter includes the former
    double cpu_seconds = 0;             // of this process
    double rays = 0;
    std::vector<std::string> said;
};

/// Its kinds outlive it.
class Stage {
public:
    Stage(const Registry& registry, const Graph& graph);
    /// One of graphs/, with constants.
    Stage(const Registry& registry, const std::string& graph, const std::map<std::string, std::string>& constants);

    double samples() const { return double(job_.width) * job_.height * format_.samples; }
    std::uint32_t samples_per_pixel() const { return format_.samples; }

    /// Everything that a run does: builds the scene, begins places, prepares, renders, ends.
    Rendered in_threads(std::uint32_t places);
    /// On hosts that have the scene: gather() has returned. Without its end.
    Rendered on(Cluster& cluster, std::uint64_t run);
    Cluster::Options options(std::vector<std::string> endpoints, std::uint64_t run) const;
    /// Asks two hosts for so many millionths of all answers, from now on.
    void verify(std::uint32_t millionths) { job_.tuning.verify = millionths; }
    /// Of all random numbers, from now on.
    void use_seed(std::uint64_t seed) { job_.seed = seed; }
    /// Where what is prepared is kept, from now on. It outlives this.
    void use(ResultCache& cache) { cache_ = &cache; }

private:
    void lead(Carrier& carrier, const Plan& plan, std::uint64_t run, const std::function<void()>& check,
              Rendered& made);

    const Registry& registry_;
    Job job_;
    std::map<std::string, Bytes> files_;
    FilmFormat format_;
    ResultCache* cache_ = nullptr;
    std::size_t image_ = 0;
    float scale_ = 1;
};

}  // namespace lightnet::bench
