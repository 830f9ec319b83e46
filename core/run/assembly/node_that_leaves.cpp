#include "core/run/assembly/node_that_leaves.hpp"

#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

/// As long as it lives, the node stays.
class NodeThatLeaves::Visit {
public:
    explicit Visit(const NodeThatLeaves& at) : at_(at) { ++at_.inside_; }
    ~Visit() {
        if (--at_.inside_ == 0 && at_.leaves_) at_.light_.reset();
    }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

private:
    const NodeThatLeaves& at_;
};

void NodeThatLeaves::leave() {
    leaves_ = true;
    if (inside_ == 0) light_.reset();
}

LightOp& NodeThatLeaves::node() const {
    if (!light_) throw Error("has left this place");
    return *light_;
}

void NodeThatLeaves::prepare(Services& services) {
    leaves_ = false;
    if (!light_) light_ = make_();
    const Visit visit(*this);
    node().prepare(services);
}

Frozen NodeThatLeaves::frozen() const { return node().frozen(); }

void NodeThatLeaves::light(std::span<const Query> questions, std::span<Rgb> answers) const {
    const Visit visit(*this);
    node().light(questions, answers);
}

}  // namespace lightnet
