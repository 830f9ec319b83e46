#include "core/run/master/conducted_rehearsal.hpp"

#include <span>
#include <utility>

#include "core/network/light/rehearsal.hpp"
#include "core/run/assembly/prepared.hpp"

namespace lightnet {

ConductedRehearsal::ConductedRehearsal(std::uint32_t call, std::set<NodeCopy> copies, MasterRenderer::Job job,
                                       Carrier& carrier)
    : call_(call),
      copies_(std::move(copies)),
      blocks_(work_in(job.tiles)),
      master_(std::move(job), carrier, [](const Tile&, std::span<const Rgb>) {}) {}

bool ConductedRehearsal::collect(const Bytes& notes) {
    const auto more = values_of<Query>(notes);
    noted_.insert(noted_.end(), more.begin(), more.end());
    return ++collected_ == copies_.size();
}

Bytes ConductedRehearsal::result() {
    sort_and_unite(noted_);
    return rehearsal_result(noted_);
}

}  // namespace lightnet
