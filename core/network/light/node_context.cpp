#include "core/network/light/node_context.hpp"

#include "core/base/error.hpp"
#include "core/film/tile.hpp"
#include "core/network/light/locks.hpp"
#include "core/network/light/rehearsal.hpp"

#include <cmath>

namespace lightnet {
namespace {

template <class T>
const T& as(const Node& node, const std::string& param, const Value& value, const char* what) {
    if (const auto* data = std::get_if<T>(&value.data)) return *data;
    throw Error(node.kind + " '" + node.name + "'", "parameter '" + param + "' is not " + what);
}

// Never begun, and of one thread's own.
thread_local Rehearsal no_rehearsal;
thread_local NoLocks no_locks;

}  // namespace

NodeContext::NodeContext(const Node& node, Inputs inputs, const Scene& scene, std::uint64_t seed, NodeServices services)
    : node_(node), inputs_(std::move(inputs)), scene_(scene), seed_(seed), services_(std::move(services)) {
    if (!services_.rehearsal) services_.rehearsal = &no_rehearsal;
    if (!services_.locks) services_.locks = &no_locks;
}

void NodeContext::each(std::size_t count, std::size_t at_once, const Concurrent::Work& work) const {
    if (services_.concurrent) return services_.concurrent->each(node_.name.c_str(), count, at_once, work);
    for (std::size_t piece = 0; piece < count; ++piece) work(piece);
}

std::uint16_t NodeContext::pass_mark(std::uint32_t sample) const {
    return services_.has_passes ? mark_of_pass(sample / samples_per_block) : 0;
}

const Value& NodeContext::value(const std::string& param) const {
    const auto found = node_.params.find(param);
    if (found == node_.params.end())
        throw Error(node_.kind + " '" + node_.name + "'",
                    "parameter '" + param + "' is neither given nor in its schema");
    return found->second;
}

const LightOp& NodeContext::taken(const std::string& param) const {
    const auto& ref = as<NodeRef>(node_, param, value(param), "a node");
    if (!services_.taken) throw Error(node_.kind + " '" + node_.name + "'", "has no node '" + ref.name + "' beside it");
    return services_.taken(ref.name);
}

double NodeContext::number(const std::string& param) const {
    return as<double>(node_, param, value(param), "a number");
}

std::int64_t NodeContext::integer(const std::string& param) const { return std::llround(number(param)); }

bool NodeContext::flag(const std::string& param) const { return as<bool>(node_, param, value(param), "true or false"); }

const std::string& NodeContext::text(const std::string& param) const {
    return as<std::string>(node_, param, value(param), "text");
}

std::vector<double> NodeContext::numbers(const std::string& param) const {
    std::vector<double> result;
    for (const auto& entry : as<Table>(node_, param, value(param), "a list of numbers").list)
        result.push_back(as<double>(node_, param, entry, "a list of numbers"));
    return result;
}

}  // namespace lightnet
