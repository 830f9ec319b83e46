#include "tools/forecast/recorded_run.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/json.hpp"
#include "core/base/own_process.hpp"
#include "core/base/plain_file.hpp"
#include "core/film/tile.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/forecast/place_work.hpp"
#include "tools/explain/past_run.hpp"

namespace lightnet {
namespace {

constexpr JsonLimits limits_of_report{.depth = JsonLimits{}.depth + 4};  // around the graph's own levels
constexpr double memory_of_results = 3;   // times their bytes: with what is built from them, as photon maps are
constexpr double bytes_of_question = 60;  // and of a colour, where none was sent
// What a node learns where a picture looks at costs the more the larger the picture is, and less than its pixels do.
// DECISIONS: records-by-side
constexpr double grows_of_records = 0.8, grows_of_pixels = 2;

double number_in(const Json& object, std::string_view member) {
    return object.has(member) ? object.at(member).number() : 0;
}

std::uint32_t whole_in(std::string_view text) {
    std::uint32_t number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc{} || end != text.data() + text.size() || number == 0)
        throw Error("'" + std::string(text) + "' is no number of its settings");
    return number;
}

/// Takes one report apart.
class ReportOfCosts {
public:
    ReportOfCosts(const Json& report, const Graph& graph, const Registry& registry)
        : report_(report), kinds_(registry) {
        run_.graph = graph;
        auto& costs = run_.costs;
        costs.image = renderer_of(graph, registry);
        const auto used = used_nodes(graph, costs.image);
        for (const auto node : leaves_first(edges_of(graph)))
            if (used[node] && registry.find(graph.nodes[node].kind)->role != Role::scene) costs.order.push_back(node);
        for (const auto& node : graph.nodes) costs.nodes.push_back({node.name});
        for (const auto node : costs.order)
            for (const auto taken : graph.taken_by(node)) costs.beside.emplace_back(node, taken);
    }

    RecordedRun read() {
        if (report_.at("outcome").text() != "done") throw Error("it was not done");
        read_picture();
        read_spread();
        read_nodes();
        read_edges();
        read_launcher();
        read_places();
        read_moves();
        return std::move(run_);
    }

private:
    std::size_t node_called(const std::string& name) const {
        const auto node = run_.graph.find(name);
        if (!node) throw Error("its graph has no node '" + name + "'");
        return *node;
    }

    void read_picture() {
        const auto& settings = report_.at("settings");
        const auto& size = settings.at("size").text();
        auto& picture = run_.costs.picture;
        picture.width = whole_in(std::string_view(size).substr(0, size.find('x')));
        picture.height = whole_in(std::string_view(size).substr(std::min(size.find('x') + 1, size.size())));
        picture.samples = whole_in(settings.at("samples").text());
        picture.tile = whole_in(settings.at("tile").text());
        if (report_.has("layers"))
            picture.colours = static_cast<std::uint32_t>(std::max<std::size_t>(1, report_.at("layers").list().size()));
    }

    void read_spread() {
        for (const auto& node : report_.at("nodes").list()) {
            if (node_called(node.at("name").text()) != run_.costs.image || !node.has("spread")) continue;
            for (const auto& entry : node.at("spread").list()) {
                const double seconds = entry.list(2)[0].number(), count = entry.list(2)[1].number();
                blocks_ += count;
                run_.costs.spread.push_back({seconds, count});
            }
        }
        if (blocks_ <= 0)
            throw Error(report_.at("mode").text() == "serial"
                            ? "nobody times the pieces of a run of one thread; record one with --threads 2"
                            : "it says nothing of what tiles took: an older version has recorded it");
        double sum = 0;
        for (const auto& share : run_.costs.spread) sum += share.times * share.weight;
        for (auto& share : run_.costs.spread) share.times *= blocks_ / sum;
    }

    // Blocks of usual tiles: those at the edges are smaller.
    double usual() const {
        const auto& picture = run_.costs.picture;
        const auto along = [&](std::uint32_t pixels) { return std::ceil(double(pixels) / picture.tile); };
        const double whole = along(picture.width) * along(picture.height) * picture.tile * picture.tile;
        return blocks_ * picture.width * picture.height / whole;
    }

    void read_nodes() {
        for (const auto& entry : report_.at("nodes").list()) {
            const auto index = node_called(entry.at("name").text());
            auto& node = run_.costs.nodes[index];
            seconds_[index] = entry.at("seconds").number();
            questions_[index] = index == run_.costs.image ? usual() : entry.at("questions").number();
            if (!entry.has("preparing")) continue;
            const auto& preparing = entry.at("preparing");
            auto& cost = node.preparing;
            cost.shard_seconds = preparing.at("seconds").number();
            cost.own_seconds = preparing.at("own_seconds").number();
            cost.bytes = preparing.at("bytes").number();
            cost.shards = preparing.at("shards").whole<std::uint32_t>();
            cost.rehearses = kinds_.find(run_.graph.nodes[index].kind)->run.rehearses;
            cost.rounds = preparing.has("rounds") ? preparing.at("rounds").whole<std::uint32_t>() : 0;
            if (cost.shards == 0 && cost.shard_seconds > 0) cost.shards = rehearsed_tiles();
            node.memory = memory_of_results * cost.bytes;
            seconds_[index] -= cost.shard_seconds;
        }
    }

    std::uint32_t rehearsed_tiles() const {
        const auto& picture = run_.costs.picture;
        const auto along = [&](std::uint32_t pixels) { return (pixels + picture.tile - 1) / picture.tile; };
        return along(picture.width) * along(picture.height);
    }

    void read_edges() {
        for (const auto& entry : report_.at("edges").list()) {
            EdgeCost edge{node_called(entry.at("from").text()), node_called(entry.at("to").text())};
            const double sent = entry.at("sent").number(), asked = entry.at("questions").number();
            seconds_[edge.from] -= entry.at("called_seconds").number() - number_in(entry, "learning_seconds");
            const double all = questions_[edge.from];
            edge.questions = all > 0 ? (asked - number_in(entry, "learning")) / all : 0;
            edge.bytes = sent > 0 ? entry.at("bytes").number() / sent : bytes_of_question;
            run_.costs.edges.push_back(edge);
        }
        for (const auto& [node, seconds] : seconds_)
            if (questions_[node] > 0) run_.costs.nodes[node].seconds = std::max(0.0, seconds) / questions_[node];
    }

    void read_launcher() {
        const double tiles = std::max(1.0, report_.at("counters").at("tiles").number());
        for (const auto& phase : report_.at("phases").list()) {
            const auto& name = phase.at("name").text();
            const double seconds = phase.at("seconds").number();
            run_.seconds += seconds;
            if (name == "load") run_.costs.load_seconds = seconds;
            if (name == "write") run_.costs.write_seconds = seconds;
            if (name == "render") run_.costs.launcher_tile_seconds = number_in(phase, "processor") / tiles;
        }
    }

    void read_places() {
        auto& plan = run_.plan;
        plan.places_of.resize(run_.graph.nodes.size());
        for (const auto& place : report_.at("places").list()) {
            std::string host = place.at("host").text();
            if (host == own_process) host.clear();
            const auto known =
                std::find_if(run_.hosts.begin(), run_.hosts.end(), [&](const auto& one) { return one.name == host; });
            if (known == run_.hosts.end())
                run_.hosts.push_back({host});
            else
                ++known->places;
            const auto number = static_cast<std::uint32_t>(plan.places.size());
            plan.places.push_back({host, place.at("index").whole<std::uint32_t>()});
            for (const auto& name : place.at("nodes").list())
                plan.places_of[node_called(name.text().substr(0, name.text().find('#')))].push_back(number);
        }
        const auto others =
            std::count_if(run_.hosts.begin(), run_.hosts.end(), [](const auto& host) { return !host.name.empty(); });
        if (others > 0) run_.costs.host_bytes = number_in(report_.at("counters"), "file_bytes") / double(others);
    }

    void read_moves() {
        if (!report_.has("moves")) return;
        for (const auto& move : report_.at("moves").list())
            for (const auto& text : move.at("nodes").list()) {
                run_.moves.push_back(move_said(text.text()));
                run_.moves.back().seconds = move.at("seconds").number();
            }
    }

    const Json& report_;
    const Registry& kinds_;
    RecordedRun run_;
    double blocks_ = 0;
    std::map<std::size_t, double> seconds_;    // of threads, by node, while it rendered
    std::map<std::size_t, double> questions_;  // that it answered
};

// "a, b"; this process is "" in plans.
std::vector<std::string> hosts_in(std::string_view text) {
    std::vector<std::string> hosts;
    while (!text.empty()) {
        const auto comma = text.find(", ");
        hosts.emplace_back(text.substr(0, comma));
        if (hosts.back() == own_process) hosts.back().clear();
        text = comma == std::string_view::npos ? "" : text.substr(comma + 2);
    }
    return hosts;
}

}  // namespace

DrawnMove move_said(const std::string& text) {
    const auto behind = [&](std::string_view words) {
        const auto at = text.find(words);
        return at == std::string::npos ? std::string_view() : std::string_view(text).substr(at + words.size());
    };
    DrawnMove move{text.substr(0, text.find(' ')), {}, {}};
    if (const auto way = behind(" goes from "); !way.empty())
        move.from = hosts_in(way.substr(0, way.find(" to "))), move.to = hosts_in(behind(" to "));
    else if (const auto come = behind(" comes to "); !come.empty())
        move.to = hosts_in(come);
    else
        move.from = hosts_in(behind(" leaves "));
    if (move.from.empty() && move.to.empty()) throw Error("'" + text + "' is no move of a node");
    return move;
}

RecordedRun read_recorded_run(const std::filesystem::path& report, const Registry& registry) {
    const auto past = read_past_run(report, registry);
    try {
        const std::string text = PlainFile(report, limits_of_report.bytes).text();
        const Json json = parse_json(text, limits_of_report);
        return ReportOfCosts(json, past.graph, registry).read();
    } catch (const Error& wrong) {
        throw UserError({report.string(), 0}, std::string("can't be predicted from: ") + wrong.what());
    }
}

RunCosts scaled(RunCosts costs, const OtherPicture& other) {
    auto& picture = costs.picture;
    const auto before = picture;
    if (other.width) picture.width = other.width, picture.height = other.height;
    if (other.samples) picture.samples = other.samples;
    if (other.tile) picture.tile = other.tile;
    if (other.frames) picture.frames = other.frames;
    const auto in_block = [](const PictureCost& one) { return double(std::min(one.samples, samples_per_block)); };
    const double side = double(picture.tile) / before.tile;
    const double times = side * side * in_block(picture) / in_block(before);
    costs.nodes[costs.image].seconds *= times;
    costs.launcher_tile_seconds *= side * side;
    const double sides =
        std::sqrt(double(picture.width) * picture.height / (double(before.width) * double(before.height)));
    for (std::size_t i = 0; i < costs.nodes.size(); ++i) {
        auto& node = costs.nodes[i];
        auto& preparing = node.preparing;
        if (i != costs.image && !preparing.rehearses) continue;
        const double larger = std::pow(sides, i == costs.image ? grows_of_pixels : grows_of_records);
        preparing.shards = std::uint32_t(std::ceil(larger * preparing.shards));
        preparing.shard_seconds *= larger, preparing.own_seconds *= larger, preparing.bytes *= larger;
        node.memory *= larger;
    }
    costs.write_seconds *= double(picture.width) * picture.height / (double(before.width) * before.height);
    for (auto& edge : costs.edges)
        if (edge.from == costs.image) edge.questions *= times;
    return costs;
}

}  // namespace lightnet
