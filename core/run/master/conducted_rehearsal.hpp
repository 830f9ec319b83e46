// A rehearsal that goes on: its tiles are rendered, then what the nodes noted is collected.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "core/base/bytes.hpp"
#include "core/base/query.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/master/node_copy.hpp"

namespace lightnet {

/// One rehearsal of one node, with the copies that held it when it began; who comes later does not take part. It is
/// broken when a copy is lost, and with it what it had noted: then it has to begin again. Belongs to the launcher's
/// thread.
class ConductedRehearsal {
public:
    /// `call`: the node's call that it answers. Renders nothing before it is told by use() where.
    ConductedRehearsal(std::uint32_t call, std::set<NodeCopy> copies, MasterRenderer::Job job, Carrier& carrier);

    std::uint32_t call() const { return call_; }
    const std::set<NodeCopy>& copies() const { return copies_; }
    void use(const Plan& plan) { master_.use(plan); }
    void break_off() { broken_ = true; }
    bool broken() const { return broken_; }

    /// Renders on for about `most`, until all tiles are there.
    void render(std::chrono::nanoseconds most) { rendered_ = master_.work(most); }
    bool rendered() const { return rendered_; }
    /// Blocks of samples.
    std::size_t blocks() const { return blocks_; }
    std::size_t blocks_done() const { return blocks_ - master_.unanswered(); }

    /// Has this copy still to be asked what it noted?
    bool wants_notes_of(const NodeCopy& copy) const { return rendered_ && !broken_ && !asked_.contains(copy); }
    void asked(const NodeCopy& copy) { asked_.insert(copy); }
    /// What a copy has noted. True when all have said so.
    bool collect(const Bytes& notes);
    /// The result of the call, when all is collected.
    Bytes result();

private:
    std::uint32_t call_;
    std::set<NodeCopy> copies_;
    std::size_t blocks_;
    MasterRenderer master_;
    bool rendered_ = false, broken_ = false;
    std::set<NodeCopy> asked_;
    std::size_t collected_ = 0;  // copies that have said what they noted
    std::vector<Query> noted_;
};

}  // namespace lightnet
