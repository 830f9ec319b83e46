// What a node could not answer well, noted down while a rehearsal is on.
#pragma once

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
        if (on_) noted_.push_back(question);
    }

    // For those who run the rehearsal.
    void begin() { on_ = true; }
    /// Ends it. All that was noted, sorted, each question once.
    std::vector<Query> end();
    /// The same while it goes on.
    const std::vector<Query>& noted();

private:
    bool on_ = false;
    std::vector<Query> noted_;
};

/// Sorts by stream, sample and so on, and drops what is there twice.
void sort_and_unite(std::vector<Query>& questions);

}  // namespace lightnet
