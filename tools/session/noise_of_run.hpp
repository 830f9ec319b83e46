// The noise of a run's picture: how much there is, and which light paths make it.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>

#include "core/network/graph/kind.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/assembly/load_scene.hpp"

namespace lightnet {

class RunRecorder;
struct Assignment;

/// The network of a run that others render: its launcher builds it beside the run, in the background, to look again at
/// some pixels. One thread's.
class NetworkBeside {
public:
    /// Begins. `job` and `registry` outlive it.
    NetworkBeside(const Job& job, const Registry& registry, LoadedScene scene);
    /// Ends the work, where nobody has waited for it.
    ~NetworkBeside();
    NetworkBeside(const NetworkBeside&) = delete;
    NetworkBeside& operator=(const NetworkBeside&) = delete;

    /// Waits until it is there. Null: it can't be built here, for want of memory.
    std::shared_ptr<const Network> get();

private:
    std::atomic<bool> unwanted_{false};
    std::shared_ptr<const Network> built_;
    std::future<std::shared_ptr<const Network>> building_;  // last: its end uses the rest
};

/// Does it pay to build the trees of so many triangles for looking again at a picture of so many samples? By counts
/// alone, so that it is the same in all runs of it.
bool pays_to_build(std::uint64_t triangles, std::uint64_t samples);

/// Where others render, and nothing else keeps the run from looking again: the network to do it with. Else the scene's
/// data is left to who comes next, and there is none.
std::shared_ptr<NetworkBeside> network_beside(const Assignment& what, LoadedScene scene);

/// Computes some pixels of a finished picture again, and writes into the report what makes its error; nothing where
/// nodes prepare, or there is nothing to tell (see error_by_paths()). Whoever waits for each picture is not kept
/// waiting.
void note_noise(RunRecorder& book, const Assignment& what);

}  // namespace lightnet
