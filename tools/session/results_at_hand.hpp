// Results of preparing that the runs of one process hand on in memory.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "core/run/assembly/prepared.hpp"

namespace lightnet {

/// As long as it lives: nothing of them is forgotten. Any thread.
class ResultsAtHand final : public ResultCache {
public:
    Result find(const Hash& recipe) const override;
    void keep(const Hash& recipe, const Result& result) override;

private:
    mutable std::mutex mutex_;
    std::map<Hash, Result> results_;
};

/// Looks at hand first, then in the other, and keeps in both.
std::unique_ptr<ResultCache> at_hand_before(std::shared_ptr<ResultCache> at_hand, std::unique_ptr<ResultCache> other);

}  // namespace lightnet
