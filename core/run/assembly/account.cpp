#include "core/run/assembly/account.hpp"

#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {

// What is asked for the answer stands behind it.
void AccountKeeper::ask(std::size_t asker, std::size_t asked, Port& port, const Query& question,
                        std::span<Rgb> answer) {
    auto& questions = account_.questions;
    const auto mine = questions.size(), outer = std::exchange(within_, mine);
    questions.push_back({asker, asked, outer, question, {}});
    if (const auto ticket = port.begin({&question, 1}, answer)) port.finish(ticket);
    questions[mine].answer.assign(answer.begin(), answer.end());
    within_ = outer;
}

class AccountKeeper::Watching final : public RayWitness {
public:
    explicit Watching(AccountKeeper& keeper) : keeper_(keeper) {}
    void met(const Ray& ray, const std::optional<Hit>& hit) override {
        keeper_.account_.rays.push_back({keeper_.within_, keeper_.account_.questions.size(), ray, hit, false, false});
    }
    void looked(const Ray& ray, bool hidden) override {
        keeper_.account_.rays.push_back(
            {keeper_.within_, keeper_.account_.questions.size(), ray, std::nullopt, true, hidden});
    }

private:
    AccountKeeper& keeper_;
};

AccountKeeper::AccountKeeper() : watching_(std::make_unique<Watching>(*this)) {}

AccountKeeper::~AccountKeeper() {
    if (keeps_) watch_rays(before_);
}

void AccountKeeper::begin() {
    account_ = {};
    within_ = AskedQuestion::nobody;
    keeps_ = true;
    before_ = watch_rays(watching_.get());
}

Account AccountKeeper::end() {
    watch_rays(std::exchange(before_, nullptr));
    keeps_ = false;
    return std::exchange(account_, {});
}

}  // namespace lightnet
