#include "tools/explain/explanation_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/json_tree.hpp"
#include "tools/explain/named_surface.hpp"

namespace lightnet {
namespace {

using Tree = JsonTree;

// Floats survive as decimal numbers; what is no number has no name in JSON, and goes by its bits.
Tree tree_of(float number) {
    if (std::isfinite(number)) return number;
    return fmt::format("{:#x}", std::bit_cast<std::uint32_t>(number));
}
Tree tree_of(Vec3 v) { return {tree_of(v.x), tree_of(v.y), tree_of(v.z)}; }
Tree tree_of(Rgb c) { return {tree_of(c.r), tree_of(c.g), tree_of(c.b)}; }
Tree tree_of(const std::vector<Rgb>& colours) {
    Tree list = Tree::list();
    for (const auto& colour : colours) list.push_back(tree_of(colour));
    return list;
}

float float_of(const Json& json) {
    if (!std::holds_alternative<std::string>(json.data)) return static_cast<float>(json.number());
    return std::bit_cast<float>(static_cast<std::uint32_t>(std::strtoul(json.text().c_str(), nullptr, 16)));
}

// Programs that know numbers by 53 bits must not spoil it, so the stream is text.
Tree tree_of(const Query& query) {
    return {{"stream", fmt::format("{:#018x}", query.stream)},
            {"instance", query.instance},
            {"geometry", query.geometry},
            {"primitive", query.primitive},
            {"u", tree_of(query.u)},
            {"v", tree_of(query.v)},
            {"outgoing", tree_of(query.outgoing)},
            {"sample", query.sample},
            {"lobes", query.lobes},
            {"depth", query.depth},
            {"pass", query.pass}};
}

Query query_of(const Json& tree) {
    Query query;
    query.stream = std::strtoull(tree.at("stream").text().c_str(), nullptr, 16);
    query.instance = tree.at("instance").whole<decltype(query.instance)>();
    query.geometry = tree.at("geometry").whole<decltype(query.geometry)>();
    query.primitive = tree.at("primitive").whole<decltype(query.primitive)>();
    query.u = float_of(tree.at("u")), query.v = float_of(tree.at("v"));
    const auto& out = tree.at("outgoing").list(3);
    query.outgoing = {float_of(out[0]), float_of(out[1]), float_of(out[2])};
    query.sample = tree.at("sample").whole<decltype(query.sample)>();
    query.lobes = tree.at("lobes").whole<decltype(query.lobes)>();
    query.depth = tree.at("depth").whole<decltype(query.depth)>();
    query.pass = tree.at("pass").whole<decltype(query.pass)>();
    return query;
}

Tree tree_of(const NamedSurface& surface) {
    return {{"shape", surface.shape},
            {"material", surface.material},
            {"object", surface.object},
            {"where", surface.where},
            {"position", tree_of(surface.position)}};
}

Tree within_of(std::size_t within) { return within == AskedQuestion::nobody ? Tree(nullptr) : Tree(within); }

Tree question_tree(const AskedQuestion& asked, const Graph& graph) {
    return {{"asker", graph.nodes[asked.asker].name},
            {"asked", graph.nodes[asked.asked].name},
            {"question", tree_of(asked.question)},
            {"answer", tree_of(asked.answer)}};
}

Tree ray_tree(const TracedRay& ray, const Scene& scene) {
    Tree tree{{"within", within_of(ray.within)},
              {"questions_before", ray.questions_before},
              {"origin", tree_of(ray.ray.origin)},
              {"direction", tree_of(ray.ray.direction)}};
    if (ray.looks) {
        tree["far"] = std::isfinite(ray.ray.far) ? Tree(ray.ray.far) : Tree(nullptr);
        tree["hidden"] = ray.hidden;
    } else {
        tree["meets"] = ray.hit ? tree_of(named_surface(scene, *ray.hit)) : Tree(nullptr);
    }
    return tree;
}

Tree sample_tree(const PixelAccount& account, const ExplainedSample& part) {
    const auto& network = *account.network;
    Tree layers = Tree::object(), questions = Tree::list(), rays = Tree::list();
    for (const std::size_t k : account.format.views())
        if (account.format.is_plain(k)) layers[account.format.name_of(k)] = tree_of(part.colours[k]);
    for (const auto& asked : part.account.questions) {
        Tree& tree = questions.push_back(question_tree(asked, network.graph));
        tree["within"] = within_of(asked.within);
        tree["surface"] = tree_of(named_point(*network.scene, asked.question));
    }
    for (const auto& ray : part.account.rays) rays.push_back(ray_tree(ray, *network.scene));
    return {{"sample", part.sample},
            {"colour", tree_of(part.beauty)},
            {"layers", layers},
            {"questions", questions},
            {"rays", rays}};
}

std::size_t node_called(const std::string& name, const Graph& graph) {
    const auto node = graph.find(name);
    if (!node) throw Error("the graph has no node '" + name + "'");
    return *node;
}

}  // namespace

std::string explanation_json(const PixelAccount& account, const std::string& picture, std::size_t most) {
    const auto& pixel = account.pixel;
    Tree layers = Tree::list(), samples = Tree::list();
    for (const auto& layer : pixel.layers)
        layers.push_back({{"name", layer.name}, {"colour", tree_of(layer.pixels[0])}, {"gain", tree_of(layer.gain)}});
    for (std::size_t i = 0; i < std::min(most, account.parts.size()); ++i)
        samples.push_back(sample_tree(account, account.parts[i]));
    const Tree tree{{"format", "lightnet explanation 1"},
                    {"picture", picture},
                    {"pixel", {account.x, account.y}},
                    {"samples", account.samples},
                    {"equal", account.equal.value_or(false)},
                    {"colour", tree_of(pixel.beauty[0])},
                    {"layers", layers},
                    {"brightest", samples}};
    return to_text(tree, {.indent = 1}) + "\n";
}

std::string question_line(const AskedQuestion& asked, const Graph& graph) {
    return to_text(question_tree(asked, graph), {.strict = true}) + "\n";
}

AskedQuestion question_of_line(const std::string& line, const Graph& graph) {
    AskedQuestion asked;
    std::string asker, target;
    try {
        const Json json = parse_json(line);
        asker = json.at("asker").text(), target = json.at("asked").text();
        asked.question = query_of(json.at("question"));
        for (const auto& answer : json.at("answer").list()) {
            const auto& colour = answer.list(3);
            asked.answer.push_back({float_of(colour[0]), float_of(colour[1]), float_of(colour[2])});
        }
    } catch (const JsonError& wrong) {
        throw Error("this line is no question", wrong.what());
    }
    asked.asker = node_called(asker, graph), asked.asked = node_called(target, graph);
    return asked;
}

}  // namespace lightnet
