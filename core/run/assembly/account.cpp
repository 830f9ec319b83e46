#include "core/run/assembly/account.hpp"

#include <utility>

#include "core/network/light/port.hpp"

namespace lightnet {

class AccountKeeper::TappedPort final : public Port {
public:
    TappedPort(AccountKeeper& keeper, std::size_t asker, std::size_t asked, std::size_t width, Port& port)
        : keeper_(keeper), asker_(asker), asked_(asked), width_(width), port_(port) {}

    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        if (!keeper_.keeps_) return port_.begin(questions, answers);
        for (std::size_t q = 0; q < questions.size(); ++q) ask(questions[q], answers.subspan(q * width_, width_));
        return 0;
    }
    void finish(Ticket ticket) override { port_.finish(ticket); }
    void abandon(Ticket ticket) noexcept override { port_.abandon(ticket); }

private:
    void ask(const Query& question, std::span<Rgb> answer) {
        auto& asked = keeper_.account_.questions;
        const auto outer = std::exchange(keeper_.within_, asked.size());
        const auto mine = keeper_.within_;
        asked.push_back({asker_, asked_, outer, question, {}});
        if (const auto ticket = port_.begin({&question, 1}, answer)) port_.finish(ticket);
        asked[mine].answer.assign(answer.begin(), answer.end());
        keeper_.within_ = outer;
    }

    AccountKeeper& keeper_;
    std::size_t asker_, asked_, width_;
    Port& port_;
};

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

Assembly::Tap AccountKeeper::tap() {
    return [this](std::size_t asker, std::size_t asked, std::size_t width, Port* port) -> Port* {
        return ports_.emplace_back(std::make_unique<TappedPort>(*this, asker, asked, width, *port)).get();
    };
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
