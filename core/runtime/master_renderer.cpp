#include "core/runtime/master_renderer.hpp"

#include "core/error.hpp"

namespace lightnet {

MasterRenderer::MasterRenderer(Job job, Carrier& carrier, Done done)
    : job_(std::move(job)),
      carrier_(carrier),
      done_(std::move(done)),
      channels_(carrier, job_.run, 0, counters_),
      edge_{job_.image, job_.credit, {}},
      unanswered_(job_.tiles.size()) {}

void MasterRenderer::use(const Plan& plan) {
    if (!std::exchange(planned_, true)) {
        MultiplexerRules rules;
        rules.scheduling.strategy = plan.strategy_of(job_.image);
        rules.scheduling.double_tail = job_.double_tail;
        rules.clock = job_.clock;
        if (job_.check) rules.differs = [this](const std::string& what) { error_ = what; };
        replicas_.follow(std::move(rules), &counters_);
    }
    channels_.connect(edge_, replicas_, plan);
}

void MasterRenderer::append(const std::vector<Tile>& tiles) {
    if (draining_) return;
    job_.tiles.insert(job_.tiles.end(), tiles.begin(), tiles.end());
    unanswered_ += tiles.size();
}

void MasterRenderer::hand_out() {
    replicas_.foresee(job_.tiles.size() - next_);
    while (next_ < job_.tiles.size() && replicas_.has_credit()) {
        const auto number = next_++;
        replicas_.foresee(job_.tiles.size() - next_);
        auto tile = std::make_shared<const std::vector<Tile>>(1, job_.tiles[number]);
        replicas_.send({std::move(tile), this, number, job_.width});
    }
    replicas_.tick();
}

void MasterRenderer::take_in() {
    while (auto message = carrier_.receive()) {
        if (message->run != job_.run) continue;
        if (message->type == Message::Type::plan)
            use(*message->plan);
        else if (message->type == Message::Type::reply || message->type == Message::Type::failure)
            channels_.arrived(*message);
        if (!error_.empty()) throw Error(error_);
    }
}

bool MasterRenderer::work(std::chrono::nanoseconds most) {
    const double end = job_.clock() + std::chrono::duration<double>(most).count();
    while (unanswered_ > 0) {
        hand_out();
        const double left = end - job_.clock();
        if (left <= 0) return false;
        carrier_.wait(std::min(std::chrono::nanoseconds(static_cast<std::int64_t>(left * 1e9)), replicas_.until_due()));
        take_in();
    }
    return true;
}

void MasterRenderer::settle(std::chrono::nanoseconds most) {
    const double end = job_.clock() + std::chrono::duration<double>(most).count();
    while (outstanding() > 0 && job_.clock() < end) {
        replicas_.tick();
        carrier_.wait(replicas_.until_due());
        take_in();
    }
}

void MasterRenderer::drain() {
    draining_ = true;
    next_ = job_.tiles.size();
    replicas_.drop_waiting();
}

void MasterRenderer::answered(const Bundle<Tile>& bundle, std::vector<Rgb> pixels) {
    --unanswered_;
    done_(bundle.questions->front(), pixels);
}

void MasterRenderer::failed(const Bundle<Tile>&, const std::string& why) {
    if (error_.empty()) error_ = why;
}

void MasterRenderer::set_aside(const Bundle<Tile>&, const std::string& why) {
    --unanswered_;
    set_aside_.push_back(why);
}

}  // namespace lightnet
