#include "core/network/graph/dot.hpp"

#include "core/network/graph/layout.hpp"
#include "core/network/graph/light_paths.hpp"

#include <algorithm>
#include <string_view>

namespace lightnet {
namespace {

std::string escaped(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '\n') {
            out += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

// Of texts that look like HTML.
std::string in_html(std::string_view text) {
    std::string out;
    for (const char c : text)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

using Texts = std::map<std::string, std::string>;

/// What the two kinds of drawing share: the text, and what is known of the graph.
class Drawing {
protected:
    Drawing(const Graph& graph, const Registry& registry, const Texts& pictures)
        : graph_(graph),
          registry_(registry),
          pictures_(pictures),
          layers_(layers_of(graph, registry)),
          renderer_(renderer_of(graph, registry)) {
        text_ =
            "digraph lightnet {\n"
            "  rankdir=LR;\n"
            "  node [shape=box, style=rounded, fontname=\"Helvetica\"];\n"
            "  edge [fontname=\"Helvetica\", fontsize=10];\n";
    }

    std::string take() { return std::move(text_) + "}\n"; }

    Role role(std::size_t node) const { return registry_.find(graph_.nodes[node].kind)->role; }

    void line(int depth, const std::string& what) {
        text_ += std::string(2 * static_cast<std::size_t>(depth), ' ') + what + "\n";
    }

    void draw_node(int depth, const std::string& id, std::size_t node) {
        const auto& [name, kind, entries, params, where] = graph_.nodes[node];
        if (role(node) == Role::scene)
            return line(depth, id + " [shape=note, label=" + escaped(name + "\n" + scene_name(node)) + "];");
        const bool image = role(node) == Role::image;
        const auto paths = paths_text(graph_.nodes[node], *registry_.find(kind));
        const std::string text = name + "\n" + kind + (paths.empty() ? "" : "\n" + paths);
        const auto picture = pictures_.find(name);
        line(depth, id + " [label=" + (picture == pictures_.end() ? escaped(text) : shown(picture->second, text)) +
                        (image ? ", penwidth=2" : "") + "];");
    }

    // An image, and below it a text.
    static std::string shown(const std::string& file, const std::string& text) {
        std::string below = in_html(text);
        for (std::size_t at = 0; (at = below.find('\n', at)) != std::string::npos;) below.replace(at, 1, "<BR/>");
        return "<<TABLE BORDER=\"0\"><TR><TD><IMG SRC=\"" + in_html(file) + "\"/></TD></TR><TR><TD>" + below +
               "</TD></TR></TABLE>>";
    }

    void edge(const std::string& from, const std::string& to, const std::string& label, const char* more = "") {
        line(1, from + " -> " + to + " [label=" + escaped(label) + more + "];");
    }

    // What travels to a light operator, and what comes back.
    std::string light(std::size_t node) const {
        const std::size_t colours = layers_.of_node[node].size();
        return colours == 1 ? "Query → Rgb" : "Query → " + std::to_string(colours) + " × Rgb";
    }

    static constexpr const char* tiles = "Tile → Pixels";

    std::string scene_name(std::size_t node) const {
        return std::get<std::string>(graph_.nodes[node].entries.at(0).data);
    }

    // The scenes that a node's parameters name.
    std::vector<std::size_t> scenes_of(std::size_t node) const {
        std::vector<std::size_t> scenes;
        for (const auto& [key, value] : graph_.nodes[node].params)
            if (const auto* ref = std::get_if<NodeRef>(&value.data))
                if (const auto scene = graph_.find(ref->name); scene && role(*scene) == Role::scene)
                    scenes.push_back(*scene);
        return scenes;
    }

    // Whom a node asks, for its answers and for what is shown beside them.
    std::vector<std::size_t> asked_by(std::size_t node) const {
        auto asked = graph_.inputs_of(node);
        if (node == renderer_) asked.insert(asked.end(), layers_.shown.begin(), layers_.shown.end());
        return asked;
    }

    // What a node takes of others at its place.
    void draw_taken(const std::string& from, const std::string& to, std::size_t taken) {
        edge(from, to, registry_.find(graph_.nodes[taken].kind)->run.freezes, ", style=dashed");
    }

    const Graph& graph_;
    const Registry& registry_;
    const Texts& pictures_;
    const Layers layers_;
    const std::size_t renderer_;

private:
    std::string text_;
};

/// The graph as its file says it: one box per node.
class GraphDrawing : Drawing {
public:
    GraphDrawing(const Graph& graph, const Registry& registry, const Texts& pictures)
        : Drawing(graph, registry, pictures) {}

    std::string draw() {
        line(1, "launcher [shape=cds, label=\"launcher\"];");
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node) draw_node(1, id(node), node);
        edge("launcher", id(renderer_), std::string(tiles) + "\ncall");
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
            for (const std::size_t input : asked_by(node)) edge(id(node), id(input), light(input) + "\ncall");
            for (const std::size_t taken : graph_.taken_by(node)) draw_taken(id(node), id(taken), taken);
            for (const std::size_t scene : scenes_of(node)) edge(id(node), id(scene), "scene", ", style=dashed");
        }
        return take();
    }

private:
    std::string id(std::size_t node) const { return "node_" + graph_.nodes[node].name; }
};

/// The graph as it runs: one box per replica, and a multiplexer wherever an asker has a choice among places of its host
/// and other hosts, or a host among its places.
class PlanDrawing : Drawing {
public:
    PlanDrawing(const Graph& graph, const Registry& registry, const Plan& plan, const Texts& host_labels,
                const Texts& pictures)
        : Drawing(graph, registry, pictures), plan_(plan), host_labels_(host_labels) {}

    std::string draw() {
        line(1, "launcher [shape=cds, label=\"launcher\"];");
        draw_hosts();
        draw_tiles();
        for (std::uint32_t place = 0; place < plan_.places.size(); ++place)
            for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
                if (holds(place, node)) draw_asks(place, node);
                if (begins_host(place) && is_dealt(plan_.places[place].host, node)) draw_dealt(place, node);
            }
        return take();
    }

private:
    std::string id(std::size_t node, std::uint32_t place) const {
        return "node_" + plain_name(node) + "_" + std::to_string(place);
    }
    std::string multiplexer_id(std::size_t node, std::uint32_t place) const {
        return "choose_" + plain_name(node) + "_" + std::to_string(place);
    }
    std::string router_id(std::size_t node, std::uint32_t place) const {
        return "route_" + plain_name(node) + "_" + std::to_string(place);
    }
    std::string dealer_id(std::size_t node, const std::string& host) const {
        std::uint32_t first = 0;
        while (plan_.places[first].host != host) ++first;
        return "deal_" + plain_name(node) + "_" + std::to_string(first);
    }
    // "photons_of_3" for the sector called "photons#3".
    std::string plain_name(std::size_t node) const {
        const auto* sector = sector_at(graph_, node);
        if (!sector) return graph_.nodes[node].name;
        return graph_.nodes[sector->node].name + "_of_" + std::to_string(sector->index + 1);
    }

    bool holds(std::uint32_t place, std::size_t node) const {
        const auto& places = plan_.places_of[node];
        return std::find(places.begin(), places.end(), place) != places.end();
    }

    // The places of a host that hold a node.
    std::vector<std::uint32_t> holders(const std::string& host, std::size_t node) const {
        std::vector<std::uint32_t> places;
        for (const auto place : plan_.places_of[node])
            if (plan_.places[place].host == host) places.push_back(place);
        return places;
    }

    bool begins_host(std::uint32_t place) const {
        return place == 0 || plan_.places[place - 1].host != plan_.places[place].host;
    }

    // Whether other hosts leave it to this one which of its places answers.
    bool is_dealt(const std::string& host, std::size_t node) const {
        if (holders(host, node).size() < 2) return false;
        if (node == renderer_ && !host.empty()) return true;
        for (std::uint32_t place = 0; place < plan_.places.size(); ++place)
            if (plan_.places[place].host != host && asked_at(place, node) &&
                (!holds(place, node) ||
                 std::ranges::any_of(holders(host, node), [&](auto other) { return relieves(other, place); })))
                return true;
        return false;
    }

    // Whether a place lacks something that the other holds: then it answers some of what both could, see Place.
    bool relieves(std::uint32_t place, std::uint32_t other) const {
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node)
            if (holds(other, node) && !holds(place, node)) return true;
        return false;
    }

    // Whom somebody on `host` asks for a node: places beside it, and other hosts. What is asked, and how it gets there.
    struct Answerer {
        std::string id, carried_by;
    };
    std::vector<Answerer> answerers(const std::string& host, std::size_t node) const {
        std::vector<Answerer> all;
        for (const auto place : plan_.places_of[node]) {
            const auto& other = plan_.places[place].host;
            if (other == host)
                all.push_back({id(node, place), "inproc"});
            else if (holders(other, node).size() == 1)
                all.push_back({id(node, place), "tcp"});
            else if (holders(other, node).front() == place)
                all.push_back({dealer_id(node, other), "tcp"});
        }
        return all;
    }

    // Whether a node of the place asks `node`, and has several replicas to choose from, none beside it.
    bool chooses(std::uint32_t place, std::size_t node) const {
        return !holds(place, node) && asked_at(place, node) && answerers(plan_.places[place].host, node).size() >= 2;
    }

    // Whether a node of the place asks `node`, or the one whose sector it stands for.
    bool asked_at(std::uint32_t place, std::size_t node) const {
        for (std::size_t asker = 0; asker < graph_.nodes.size(); ++asker)
            if (holds(place, asker) && asks(asker, node)) return true;
        return false;
    }
    bool asks(std::size_t asker, std::size_t node) const {
        const auto inputs = asked_by(asker);
        return std::find(inputs.begin(), inputs.end(), whole_of(graph_, node)) != inputs.end();
    }

    std::string host_label(const std::string& host) const {
        const auto label = host_labels_.find(host);
        if (label != host_labels_.end()) return label->second;
        return host.empty() ? "this process" : host;
    }

    void draw_hosts() {
        for (std::uint32_t place = 0; place < plan_.places.size(); ++place) {
            const std::string& host = plan_.places[place].host;
            if (begins_host(place)) {
                if (place > 0) line(1, "}");
                line(1, "subgraph cluster_host_" + std::to_string(hosts_drawn_++) + " {");
                line(2, "label=" + escaped(host_label(host)) + "; style=filled; color=lightgrey;");
            }
            draw_place(place);
            if (place + 1 == plan_.places.size() || begins_host(place + 1)) draw_dealers(host);
        }
        if (!plan_.places.empty()) line(1, "}");
    }

    void draw_dealers(const std::string& host) {
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node)
            if (is_dealt(host, node)) draw_multiplexer(2, dealer_id(node, host), node, holders(host, node).size());
    }

    void draw_place(std::uint32_t place) {
        line(2, "subgraph cluster_place_" + std::to_string(place) + " {");
        line(3, "label=" + escaped("place " + std::to_string(plan_.places[place].index)) +
                    "; style=\"filled,rounded\"; color=white;");
        for (std::size_t node = 0; node < graph_.nodes.size(); ++node) {
            if (holds(place, node)) draw_node(3, id(node, place), node);
            if (chooses(place, node))
                draw_multiplexer(3, multiplexer_id(node, place), node,
                                 answerers(plan_.places[place].host, node).size());
            if (!sectors_of(graph_, node).empty() && asked_at(place, node)) draw_router(3, place, node);
        }
        line(2, "}");
    }

    void draw_multiplexer(int depth, const std::string& id, std::size_t node, std::size_t choices) {
        const std::string label = graph_.nodes[node].name + " × " + std::to_string(choices);
        line(depth, id + " [shape=trapezium, style=solid, label=" + escaped(label) + "];");
    }

    // Questions to a sharded node go by where they lie.
    void draw_router(int depth, std::uint32_t place, std::size_t node) {
        const auto sectors = std::to_string(sectors_of(graph_, node).size());
        line(depth, router_id(node, place) + " [shape=invtrapezium, style=solid, label=" +
                        escaped(graph_.nodes[node].name + " by place\n" + sectors + " sectors") + "];");
    }

    void draw_tiles() {
        const auto all = answerers("", renderer_);
        std::string from = "launcher";
        if (all.size() > 1) {
            from = "choose_" + graph_.nodes[renderer_].name;
            draw_multiplexer(1, from, renderer_, all.size());
            edge("launcher", from, std::string(tiles) + "\ncall");
        }
        for (const auto& [to, carried_by] : all) edge(from, to, std::string(tiles) + "\n" + carried_by);
    }

    // What a host does with what it is asked as a whole; `place`: its first.
    void draw_dealt(std::uint32_t place, std::size_t node) {
        const auto& host = plan_.places[place].host;
        const std::string what = node == renderer_ ? std::string(tiles) + "\ninproc" : light(node) + "\ninproc bundles";
        for (const auto holder : holders(host, node)) edge(dealer_id(node, host), id(node, holder), what);
    }

    void draw_asks(std::uint32_t place, std::size_t node) {
        for (const std::size_t input : asked_by(node)) {
            if (sectors_of(graph_, input).empty())
                draw_way(place, id(node, place), input);
            else
                edge(id(node, place), router_id(input, place), light(input) + "\ncall");
        }
        for (const std::size_t taken : graph_.taken_by(node)) draw_taken(id(node, place), id(taken, place), taken);
        // the node stands for all that the place asks of its own multiplexers
        for (const std::size_t input : asked_by(node)) {
            if (first_asker(place, input) != node) continue;
            for (const auto sector : sectors_of(graph_, input)) {
                draw_way(place, router_id(input, place), sector);
                draw_choices(place, sector);
            }
            draw_choices(place, input);
            if (holds(place, input)) draw_relief(place, input);
        }
    }

    // Who takes some of what is asked of the replica of this place.
    void draw_relief(std::uint32_t place, std::size_t node) {
        std::set<std::pair<std::string, const char*>> others;
        for (const auto other : plan_.places_of[node]) {
            const auto& host = plan_.places[other].host;
            if (other == place || !relieves(other, place)) continue;
            const bool near = host == plan_.places[place].host, one = near || holders(host, node).size() == 1;
            others.emplace(one ? id(node, other) : dealer_id(node, host), near ? "inproc" : "tcp");
        }
        for (const auto& [to, carried_by] : others)
            edge(id(node, place), to, light(node) + "\n" + carried_by + " bundles, when busy");
    }

    void draw_way(std::uint32_t place, const std::string& from, std::size_t input) {
        if (holds(place, input))
            edge(from, id(input, place), light(input) + "\ncall");
        else if (chooses(place, input))
            edge(from, multiplexer_id(input, place), light(input) + "\ncall");
        else
            draw_bundles(from, place, input);
    }

    void draw_bundles(const std::string& from, std::uint32_t place, std::size_t input) {
        for (const auto& [to, carried_by] : answerers(plan_.places[place].host, input))
            edge(from, to, light(input) + "\n" + carried_by + " bundles");
    }

    void draw_choices(std::uint32_t place, std::size_t input) {
        if (chooses(place, input)) draw_bundles(multiplexer_id(input, place), place, input);
    }

    std::size_t first_asker(std::uint32_t place, std::size_t input) const {
        for (std::size_t asker = 0;; ++asker)
            if (holds(place, asker) && asks(asker, input)) return asker;
    }

    const Plan& plan_;
    const Texts& host_labels_;
    int hosts_drawn_ = 0;
};

}  // namespace

std::string to_dot(const Graph& graph, const Registry& registry, const Plan* plan, const Texts& host_labels,
                   const Texts& pictures) {
    return plan ? PlanDrawing(graph, registry, *plan, host_labels, pictures).draw()
                : GraphDrawing(graph, registry, pictures).draw();
}

}  // namespace lightnet
