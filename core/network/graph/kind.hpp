// A kind of node: its schema feeds validation, `describe` and the maker of the node.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math/vec.hpp"
#include "core/base/scene_parts.hpp"
#include "core/network/graph/value.hpp"

namespace lightnet {

struct Node;
struct SceneData;
class LightOp;
class NodeContext;
class Renderer;

/// What a node gives, and what an input must give.
enum class Role { light, image, scene };

enum class ParamType {
    number,
    integer,
    flag,
    text,
    numbers,
    table,        // entries with names, each a parameter
    surrounding,  // the name of a file, or a colour { r, g, b }
    film,
    scene,
    node,          // a node whose frozen state is taken: `choices` says of what
    nodes,         // a list of nodes that give light
    names,         // a name, or a list of them
    named_lists,   // entries with names, each a name or a list of them
    named_colours  // entries with names, each a number or a colour { r, g, b }
};

std::string_view to_string(Role role);
std::string_view to_string(ParamType type);

/// One parameter of a kind.
struct Param {
    std::string name;
    ParamType type = ParamType::number;
    std::string help;                   // one line
    std::string unit = {};              // "scene units", "W·sr⁻¹·m⁻²", "samples", …; empty: none
    std::optional<Value> initial = {};  // the default; none: must be given
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    std::vector<std::string> choices = {};  // for text: what it may be; empty: anything
    bool optional = false;                  // may be absent without a default
    bool per_input = false;                 // for numbers: one for each input of the node, or none at all
    std::size_t count = 0;                  // for numbers: how many (or as many as the default has); 0: any number
    std::vector<Param> fields = {};         // of a table; none: any names, with numbers, texts or flags
};

/// How many nodes that give light a node may name in its array part: its inputs.
struct InputCount {
    std::size_t least = 0, most = 0;
    friend bool operator==(const InputCount&, const InputCount&) = default;
};

/// What a linear node passes on of its inputs' light.
struct PassedOn {
    std::string ends = {};  // last letters of these paths: "V", where it asks about media alone; empty: any
    bool part = false;      // of that again a part, on purpose
};

/// What nodes of a kind do with light.
struct LightTraits {
    bool linear = false;   // answers with a weighted sum of its inputs: layers pass through
    bool merges = false;   // of a renderer: its inputs' light can't be told apart, its image is one layer
    bool partial = false;  // passes on a part of its inputs' light, on purpose
    bool facts = false;    // answers with facts about the first surface that a sample meets: asked once for each, about
                           // any surface, and taken as it is, without weight or exposure. For `show` only
    bool ids = false;      // those facts are ids of names (core/film/addition.hpp), of which a pixel keeps as many as
                           // the node's parameter `ranks` says
    /// Letters of the channels of those facts in files (PictureLayer::letters); none: those of colours.
    std::function<std::string(const Node&)> letters = {};
    bool space = false;   // answers about points in media as well; else it is not asked about them: black
    bool lamps = false;   // looks for lamps: has a parameter `lamps`, and its scene has no others than those
    bool groups = false;  // can keep groups of lamps apart: has a parameter `groups`. Its scene says how many there are
                          // (Scene::groups(), 1 where nobody asks), and so many colours does it answer with
    bool converts = false;  // gives the light of the node whose frozen state it takes, in another representation
    /// Of a linear kind: what a node passes on, where that depends on its parameters; none: all of it, or a part
    /// (`partial`).
    std::function<PassedOn(const Node&)> passed = {};
    /// Which light paths a node (defaults filled in) counts by itself, as sets for PathSet::parse(): from the light to
    /// the point asked about, whose own scattering is the last letter. An empty list: what it answers is no light.
    std::function<std::vector<std::string>(const Node&)> paths = {};
    /// What happens on to the light of its inputs ("D": it is scattered once more; "": nothing). Linear kinds pass it
    /// on as it is.
    std::optional<std::string> onward = {};
};

/// Last letters of the paths by which a surface sends light on, for PassedOn::ends; a medium's: "V".
inline constexpr const char* ends_at_surface = "OBSD";

/// Paths that all nodes of a kind count alike; none: what they answer is no light.
std::function<std::vector<std::string>(const Node&)> always(std::vector<std::string> paths);

/// What nodes of a kind ask of a run, and what they leave to it.
struct RunTraits {
    bool prepares = false;   // learns something before the first question: LightOp::prepare()
    bool rehearses = false;  // asks for rehearsals meanwhile: Services::rehearse()
    bool passes = false;     // learns anew for each pass of samples: NodeContext::pass(); so do those that prepare and
                             // ask or take it. It is then made anew, and its memory does not grow with the samples
    std::string freezes = {};  // what it keeps for good when it has prepared, for nodes that take it: "photons"
    bool keeps = false;        // the result of its last call while preparing goes to the file that its parameter `keep`
                               // names; `extend` names such a file, whose content is in SceneData::kept
    /// Points of the scene that lie about as densely as what a node prepares, the same wherever they are made. Nodes of
    /// a kind that has this can be sharded: what they prepare comes from Services::map_near(), and an answer depends on
    /// nothing that lies farther from its question than was said there. Asks no inputs.
    std::function<std::vector<Vec3>(const NodeContext&)> landmarks = {};
    bool locks = false;        // holds named locks: NodeContext::locks()
    bool whole_calls = false;  // wants all questions of a call at once, to have them wait at the same time
    bool reproducible = true;  // false: draws random numbers that nobody seeds
};

/// All nodes of a kind read these parts of the scene: for Kind::reads.
std::function<SceneParts(const Node&)> reading(SceneParts parts);

/// One kind of node: its schema, what it does with light, what it asks of a run, and how a node is made.
struct Kind {
    std::string name;  // "DirectLighting"
    Role role = Role::light;
    std::string help;         // what it does, one line
    std::string plugin = {};  // that it comes from: name, version and hash of the library; "": the program itself
    InputCount inputs = {};
    std::vector<Param> params = {};
    std::map<std::string, std::string> gone = {};  // parameters that it had once, and what to write instead
    /// What is wrong with a node whose parameters fit the schema, one sentence each. `scene`: what it will be made
    /// with; null as long as that has not been read.
    std::function<std::vector<std::string>(const Node&, const SceneData* scene)> mistakes = {};
    LightTraits light = {};
    RunTraits run = {};
    /// What a node (defaults filled in) may read of the scene: of the rest it sees nothing. Results of earlier runs
    /// serve again where all that was read is as it was. None: all of it.
    std::function<SceneParts(const Node&)> reads = {};
    /// Of a renderer: what its questions hang on, of all that it reads. Where that is as it was, so is the light of
    /// whoever answers them. None: all of it.
    std::function<SceneParts(const Node&)> asks_by = {};
    std::function<std::unique_ptr<LightOp>(const NodeContext&)> make_light = {};
    std::function<std::unique_ptr<Renderer>(const NodeContext&)> make_renderer = {};
};

/// What a node passes on of its inputs' light. Who does not answer about points in media passes on nothing there.
PassedOn passed_on(const Kind& kind, const Node& node);

/// What a node of the kind may read of the scene.
SceneParts reads_of(const Kind& kind, const Node& node);

/// The kind of nodes whose light is not asked for: it is there already. They answer black. No graph file can name it.
inline constexpr const char* left_out_kind = "(left out)";

/// All kinds that a program knows, in order of name. Given by main; nothing registers itself. The kind Scene, which
/// is data and no node that anybody makes, is always among them; what is left out is found, and is not among them.
class Registry {
public:
    explicit Registry(std::vector<Kind> kinds);
    /// Kinds from elsewhere, beside those. Names must be new.
    void add(std::vector<Kind> kinds);
    /// What a plugin brings, of this name, version and hash; nothing, where it brings other things than kinds.
    void add_plugin(const std::string& plugin, std::vector<Kind> kinds);
    /// All that were added, in order.
    const std::set<std::string>& plugins() const { return plugins_; }
    const Kind* find(std::string_view name) const;
    const std::vector<Kind>& kinds() const { return kinds_; }

private:
    std::vector<Kind> kinds_;
    std::set<std::string> plugins_;
};

}  // namespace lightnet
