// Notes of a rehearsal: questions that a node could not answer well.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/query.hpp"

namespace lightnet {

/// Belongs to one node of one place. The node notes in light() the questions that it has nothing prepared for; they
/// come out of Services::rehearse(), from all places, in an order that depends on the questions alone.
class Rehearsal {
public:
    /// True while notes are taken. The answers given meanwhile reach no image.
    bool on() const { return on_; }
    void note(const Query& question) {
        if (on_ && (pass_ == 0 || question.pass == pass_)) noted_.push_back(question);
    }

    // For those who run the rehearsal.
    /// `pass`: the mark of the only pass whose questions count; 0: all do. A second copy of a tile of the pass before,
    /// which nobody waits for any more, may still ask.
    void begin(std::uint16_t pass = 0) { on_ = true, pass_ = pass; }
    /// Ends it. All that was noted, sorted, each question once.
    std::vector<Query> end();
    /// All that was noted so far, sorted, each question once; it goes on.
    const std::vector<Query>& noted();

private:
    bool on_ = false;
    std::uint16_t pass_ = 0;
    std::vector<Query> noted_;
};

/// Sorts by stream, sample and so on, and drops what is there twice.
void sort_and_unite(std::vector<Query>& questions);

}  // namespace lightnet
