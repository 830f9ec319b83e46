#include "tools/session/results_at_hand.hpp"

#include <utility>

namespace lightnet {
namespace {

class TwoCaches final : public ResultCache {
public:
    TwoCaches(std::shared_ptr<ResultCache> first, std::unique_ptr<ResultCache> second)
        : first_(std::move(first)), second_(std::move(second)) {}

    Result find(const Hash& recipe) const override {
        Result found = first_->find(recipe);
        return found.bytes ? found : second_->find(recipe);
    }
    void keep(const Hash& recipe, const Result& result) override {
        first_->keep(recipe, result);
        second_->keep(recipe, result);
    }

private:
    std::shared_ptr<ResultCache> first_;
    std::unique_ptr<ResultCache> second_;
};

}  // namespace

Result ResultsAtHand::find(const Hash& recipe) const {
    const std::lock_guard lock(mutex_);
    const auto found = results_.find(recipe);
    return found == results_.end() ? Result{} : found->second;
}

void ResultsAtHand::keep(const Hash& recipe, const Result& result) {
    const std::lock_guard lock(mutex_);
    results_[recipe] = result;
}

std::unique_ptr<ResultCache> at_hand_before(std::shared_ptr<ResultCache> at_hand, std::unique_ptr<ResultCache> other) {
    return std::make_unique<TwoCaches>(std::move(at_hand), std::move(other));
}

}  // namespace lightnet
