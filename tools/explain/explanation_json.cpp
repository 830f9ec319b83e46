#include "tools/explain/explanation_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "core/base/error.hpp"
#include "tools/explain/named_surface.hpp"

namespace lightnet {
namespace {

using Tree = nlohmann::ordered_json;

// Floats survive as decimal numbers; what is no number has no name in JSON, and goes by its bits.
Tree tree_of(float number) {
    if (std::isfinite(number)) return number;
    return fmt::format("{:#x}", std::bit_cast<std::uint32_t>(number));
}
Tree tree_of(Vec3 v) { return {tree_of(v.x), tree_of(v.y), tree_of(v.z)}; }
Tree tree_of(Rgb c) { return {tree_of(c.r), tree_of(c.g), tree_of(c.b)}; }
Tree tree_of(const std::vector<Rgb>& colours) {
    Tree list = Tree::array();
    for (const auto& colour : colours) list.push_back(tree_of(colour));
    return list;
}

float float_of(const Tree& tree) {
    if (!tree.is_string()) return tree.get<float>();
    return std::bit_cast<float>(static_cast<std::uint32_t>(std::strtoul(tree.get<std::string>().c_str(), nullptr, 16)));
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

Query query_of(const Tree& tree) {
    Query query;
    query.stream = std::strtoull(tree.at("stream").get<std::string>().c_str(), nullptr, 16);
    tree.at("instance").get_to(query.instance);
    tree.at("geometry").get_to(query.geometry);
    tree.at("primitive").get_to(query.primitive);
    query.u = float_of(tree.at("u")), query.v = float_of(tree.at("v"));
    const Tree& out = tree.at("outgoing");
    query.outgoing = {float_of(out.at(0)), float_of(out.at(1)), float_of(out.at(2))};
    tree.at("sample").get_to(query.sample);
    tree.at("lobes").get_to(query.lobes);
    tree.at("depth").get_to(query.depth);
    tree.at("pass").get_to(query.pass);
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
    Tree layers = Tree::object(), questions = Tree::array(), rays = Tree::array();
    for (const std::size_t k : account.format.views())
        if (account.format.is_plain(k)) layers[account.format.name_of(k)] = tree_of(part.colours[k]);
    for (const auto& asked : part.account.questions) {
        Tree& tree = questions.emplace_back(question_tree(asked, network.graph));
        tree["within"] = within_of(asked.within);
        tree["surface"] = tree_of(named_surface(*network.scene, network.scene->hit(asked.question)));
    }
    for (const auto& ray : part.account.rays) rays.push_back(ray_tree(ray, *network.scene));
    return {{"sample", part.sample},
            {"colour", tree_of(part.beauty)},
            {"layers", layers},
            {"questions", questions},
            {"rays", rays}};
}

std::size_t node_called(const Tree& name, const Graph& graph) {
    const auto node = graph.find(name.get<std::string>());
    if (!node) throw Error("the graph has no node '" + name.get<std::string>() + "'");
    return *node;
}

}  // namespace

std::string explanation_json(const PixelAccount& account, const std::string& picture, std::size_t most) {
    const auto& pixel = account.pixel;
    Tree layers = Tree::array(), samples = Tree::array();
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
    return tree.dump(1, ' ', false, Tree::error_handler_t::replace) + "\n";
}

std::string question_line(const AskedQuestion& asked, const Graph& graph) {
    return question_tree(asked, graph).dump() + "\n";
}

AskedQuestion question_of_line(const std::string& line, const Graph& graph) try {
    const Tree tree = Tree::parse(line);
    AskedQuestion asked;
    asked.asker = node_called(tree.at("asker"), graph), asked.asked = node_called(tree.at("asked"), graph);
    asked.question = query_of(tree.at("question"));
    for (const auto& colour : tree.at("answer"))
        asked.answer.push_back({float_of(colour.at(0)), float_of(colour.at(1)), float_of(colour.at(2))});
    return asked;
} catch (const Tree::exception& wrong) {
    throw Error("this line is no question", wrong.what());
}

}  // namespace lightnet
