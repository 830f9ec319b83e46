#include "tests/architecture/rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace lightnet::house {
namespace {

using Names = std::set<std::string, std::less<>>;

// What the rooms of transport and the tools see of core, and `more`.
Names transport_sees(Names more) {
    more.merge(Names{"core/base", "core/film", "core/scene", "core/readers", "core/network", "core/run"});
    return more;
}

// Who may include whom, beside itself. Tests may include all.
const std::map<std::string, Names, std::less<>> may_include{
    {"core/base", {}},
    {"core/film", {"core/base"}},
    {"core/scene", {"core/base"}},
    {"core/readers", {"core/base", "core/scene"}},
    {"core/network", {"core/base", "core/film"}},
    {"core/estimate", {"core/base", "core/scene", "core/network"}},
    {"core/run", {"core/base", "core/film", "core/scene", "core/readers", "core/network"}},
    {"nodes", {"core/base", "core/film", "core/scene", "core/network", "core/estimate"}},
    {"transport/address", {"core/base"}},
    {"transport/keys", {"core/base"}},
    {"transport/wire", transport_sees({"transport/keys"})},
    {"transport/places", transport_sees({})},
    {"transport/lines", transport_sees({"transport/address", "transport/keys", "transport/wire", "transport/places"})},
    {"transport/zmq",
     transport_sees({"transport/address", "transport/keys", "transport/wire", "transport/places", "transport/lines"})},
    {"transport/store", transport_sees({})},
    {"transport/start", transport_sees({"transport/keys", "transport/wire"})},
    {"transport/launcher", transport_sees({"transport/address", "transport/keys", "transport/wire", "transport/places",
                                           "transport/lines", "transport/zmq"})},
    {"transport/daemon", transport_sees({"transport/address", "transport/keys", "transport/wire", "transport/places",
                                         "transport/lines", "transport/zmq", "transport/store"})},
    {"lua", {"core/base", "core/scene", "core/network", "core/estimate"}},
    {"tools", transport_sees({"nodes", "lua", "core/estimate", "transport/address", "transport/keys", "transport/wire",
                              "transport/places", "transport/lines", "transport/zmq", "transport/store",
                              "transport/start", "transport/launcher", "transport/daemon"})},
};

/// A library, and the .cpp files that may include it.
struct Home {
    const char* library;
    std::regex include;
    std::regex files;
};

const std::array homes{
    Home{"ZeroMQ", std::regex("zmq.*"), std::regex("transport/zmq/.*")},
    Home{"msgpack", std::regex("msgpack.*"), std::regex("transport/wire/.*")},
    Home{"Lua", std::regex("(lua5.4/)?(lua(_any)?|lauxlib|lualib)\\.(h|hpp)"), std::regex("lua/.*")},
    Home{"Embree", std::regex("embree.*"), std::regex("core/scene/geometry/.*")},
    Home{"OpenEXR", std::regex("(OpenEXR/|Imath/)?(Imf|Iex|Imath|half).*"),
         std::regex("core/film/.*|core/readers/images/image_\\w+\\.cpp")},
    Home{"libpng", std::regex("png\\.h"), std::regex("core/film/.*|core/readers/images/image_\\w+\\.cpp")},
    Home{"libwebp", std::regex("webp/.*"), std::regex("core/readers/images/image_webp\\.cpp")},
    Home{"giflib", std::regex("gif_lib\\.h"), std::regex("core/readers/images/image_gif\\.cpp")},
    Home{"zstd", std::regex("zstd\\.h"), std::regex("core/readers/images/image_ktx\\.cpp")},
    Home{"libjpeg", std::regex("jpeglib\\.h"), std::regex("core/readers/images/image_\\w+\\.cpp")},
    Home{"pugixml", std::regex("pugixml\\.hpp"), std::regex("core/readers/mitsuba/.*")},
    Home{"Draco", std::regex("draco/.*"), std::regex("core/readers/gltf/draco\\.cpp")},
    Home{"meshoptimizer", std::regex("meshoptimizer\\.h"), std::regex("core/readers/gltf/meshopt\\.cpp")},
    Home{"OpenColorIO", std::regex("OpenColorIO/.*"), std::regex("core/film/ocio\\.cpp")},
    Home{"zlib", std::regex("zlib\\.h"),
         std::regex("core/(film/(npz|png)|readers/(mitsuba/\\w+|files/gzip|images/image_ktx))\\.cpp")},
    Home{"Boost.Context", std::regex("boost/context/.*"), std::regex("core/run/fiber/.*")},
    Home{"Boost.Beast", std::regex("boost/beast.*"), std::regex("tools/http/.*")},
    Home{"Boost.Asio", std::regex("boost/(?!context/|beast).*"), std::regex("tools/http/.*")},
    Home{"libcrypto", std::regex("openssl/.*"), std::regex("core/base/hash\\.cpp")},
    Home{"libsodium", std::regex("sodium.*"), std::regex("transport/keys/.*")},
    Home{"CLI11", std::regex("CLI/.*"), std::regex("tools/.*")},
    Home{"nlohmann JSON", std::regex("nlohmann/.*"), std::regex("core/base/json(_tree)?\\.cpp")},
};

bool ends_with(std::string_view text, std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// The first folder of a path; of core and transport, which are storeys of rooms, the first two.
std::string room_of(std::string_view path) {
    std::size_t storey = 0;
    for (const std::string_view name : {"core/", "transport/"})
        if (path.starts_with(name)) storey = name.size();
    return std::string(path.substr(0, path.find('/', storey)));
}
bool is_in(std::string_view room, std::string_view path) {
    return path.starts_with(room) && path.substr(room.size(), 1) == "/";
}
std::string folder_of(std::string_view path) { return std::string(path.substr(0, path.rfind('/'))); }

/// One #include of a file.
struct Include {
    std::size_t line = 0;
    bool own = false;  // "…", from the project's root
    std::string name;
};

std::vector<Include> includes_of(const SourceFile& file) {
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::vector<Include> found;
    const auto lines = lines_of(file.text);
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::regex_search(lines[i], match, pattern)) found.push_back({i + 1, match[1] == "\"", match[2]});
    return found;
}

void check_own(const SourceFile& file, const Include& include, Complaints& complaints) {
    const std::string from = room_of(file.path), to = room_of(include.name);
    if (!may_include.contains(to))
        complaints.push_back(at_line(file, include.line, "\"" + include.name + "\" is not written from the root"));
    else if (from != to && !may_include.at(from).contains(to))
        complaints.push_back(at_line(file, include.line, from + " does not see " + to));
    else if (ends_with(include.name, ".cpp"))
        complaints.push_back(at_line(file, include.line, "a .cpp file is not included"));
}

void check_foreign(const SourceFile& file, const Include& include, Complaints& complaints) {
    const bool standard = include.name.find_first_of("./") == std::string::npos;
    if (!standard && ends_with(file.path, ".hpp")) {
        complaints.push_back(at_line(file, include.line, "<" + include.name + "> in a header"));
        return;
    }
    for (const Home& home : homes)
        if (std::regex_match(include.name, home.include) && !std::regex_match(file.path, home.files))
            complaints.push_back(at_line(file, include.line, std::string(home.library) + " is not at home here"));
}

// One behind the comment that begins at `at`; `at` if none does.
std::size_t end_of_comment(std::string_view text, std::size_t at) {
    const auto begin = text.substr(at, 2);
    if (begin == "//") return std::min(text.find('\n', at), text.size());
    if (begin == "/*") return std::min(text.find("*/", at + 2), text.size() - 2) + 2;
    return at;
}

// One behind the string or character that begins at `at`; `at` if none does.
std::size_t end_of_literal(std::string_view text, std::size_t at) {
    const bool in_number = text[at] == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(text[at - 1]));
    if ((text[at] != '"' && text[at] != '\'') || in_number) return at;
    std::size_t end = at + 1;
    while (end < text.size() && text[end] != text[at] && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
    return std::min(end + 1, text.size());
}

void blank(std::string& text, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        if (text[i] != '\n') text[i] = ' ';
}

}  // namespace

std::string at_line(const SourceFile& file, std::size_t line, const std::string& why) {
    return file.path + ":" + std::to_string(line) + ": " + why;
}

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    std::istringstream stream{std::string(text)};
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

Complaints stray_includes(const SourceFile& file) {
    Complaints complaints;
    if (!may_include.contains(room_of(file.path))) return complaints;
    for (const Include& include : includes_of(file))
        (include.own ? check_own : check_foreign)(file, include, complaints);
    return complaints;
}

Complaints words_of_distribution(const SourceFile& file) {
    static const std::regex words(
        R"(\b(zmq\w*|msgpack|j?thread|thread_local|(\w+_)?mutex|atomic\w*|(shared_)?future|promise|async|condition_variable\w*|)"
        R"(\w*semaphore|latch|barrier|co_await|co_yield|co_return|coroutine|socket|fork|boost/context|boost::context|)"
        R"(whereabouts|Whereabouts|hosts?|hostname|daemon|launcher)\b)");
    Complaints complaints;
    const auto lines = lines_of(code_only(file.text));
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::regex_search(lines[i], match, words))
            complaints.push_back(at_line(file, i + 1, "a node knows nothing of '" + match.str() + "'"));
    return complaints;
}

Complaints streams_of_files(const SourceFile& file) {
    // What the system tells of itself in /proc and /sys, and pieces that arrive for a file of a new name.
    static const std::regex allowed(
        R"(core/base/(own_process|allowance)\.cpp|lua/child\.cpp|transport/wire/machine\.cpp|)"
        R"(tools/(hosts/doctor|daemon/memory_bound)\.cpp|transport/store/blob_cache\.[ch]pp)");
    static const std::regex streams(R"(\b(w?[io]?fstream|basic_[io]?fstream|filebuf|f(re)?open)\b)");
    Complaints complaints;
    if (std::regex_match(file.path, allowed)) return complaints;
    const auto lines = lines_of(code_only(file.text));
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::regex_search(lines[i], match, streams))
            complaints.push_back(at_line(file, i + 1, match.str() + ": files are read by PlainFile"));
    return complaints;
}

Complaints words_of_the_library(const SourceFile& file) {
    static const std::regex begins(R"(catch \(const std::exception& (\w+)\))");
    Complaints complaints;
    if (file.path == "core/base/words_of.cpp") return complaints;
    const auto lines = lines_of(code_only(file.text));
    std::string caught;  // what is named in the clause that is open
    std::size_t indent = 0;
    bool memory_apart = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string& line = lines[i];
        std::smatch match;
        if (line.find("catch (const std::bad_alloc&)") != std::string::npos) memory_apart = true;
        if (line.find("try {") != std::string::npos) memory_apart = false;
        if (std::regex_search(line, match, begins)) {
            caught = match[1], indent = line.find_first_not_of(' ');
            continue;
        }
        if (caught.empty()) continue;
        if (line.find(caught + ".what()") != std::string::npos && !memory_apart)
            complaints.push_back(at_line(file, i + 1, caught + ".what(): words_of(" + caught + ") is for people"));
        const auto first = line.find_first_not_of(' ');
        if (first != std::string::npos && first <= indent && line[first] == '}') caught.clear();
    }
    return complaints;
}

Complaints bad_header(const SourceFile& file) {
    Complaints complaints;
    if (!ends_with(file.path, ".hpp")) return complaints;
    const auto lines = lines_of(code_only(file.text));
    if (std::find(lines.begin(), lines.end(), "#pragma once") == lines.end())
        complaints.push_back(at_line(file, 1, "no #pragma once"));
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].find("using namespace") != std::string::npos)
            complaints.push_back(at_line(file, i + 1, "using namespace in a header"));
    return complaints;
}

Complaints borrowed_subjects(const SourceFile& file) {
    static const std::regex pattern(R"(^\s*/// The same\b)");
    Complaints complaints;
    const auto lines = lines_of(file.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::regex_search(lines[i], pattern) &&
            (i == 0 || !std::regex_search(lines[i - 1], std::regex(R"(^\s*///)"))))
            complaints.push_back(at_line(file, i + 1, "the subject of this comment stands in another one"));
    return complaints;
}

Complaints questions_for_heads(const SourceFile& file) {
    static const std::regex pattern(R"(^// (What|Who|Whoever|Whose|How|Where|Which|When|Whether|From)\b)");
    if (!std::regex_search(file.text, pattern, std::regex_constants::match_continuous)) return {};
    return {at_line(file, 1, "a noun says what the file holds, not a question")};
}

Complaints long_wraps(const SourceFile& file, std::size_t most_lines) {
    static const std::regex wrapping(R"(\bwrap<([\w:]+)>\()");
    const std::string code = code_only(file.text);
    Complaints complaints;
    for (std::sregex_iterator call(code.begin(), code.end(), wrapping), end; call != end; ++call) {
        const auto line_at = [&](auto where) { return std::count(code.begin(), code.begin() + where, '\n'); };
        std::ptrdiff_t last = call->position() + call->length();
        for (int open = 1; open > 0 && last < std::ssize(code); ++last)
            open += (code[std::size_t(last)] == '(') - (code[std::size_t(last)] == ')');
        std::set<std::ptrdiff_t> lines;
        for (auto line = line_at(call->position()); line <= line_at(last); ++line) lines.insert(line);
        const std::regex name("\\b" + (*call)[1].str() + "\\b");
        for (std::sregex_iterator use(code.begin(), code.end(), name); use != end; ++use)
            lines.insert(line_at(use->position()));
        if (lines.size() > most_lines)
            complaints.push_back(at_line(file, std::size_t(line_at(call->position())) + 1,
                                         std::to_string(lines.size()) + " lines wrap " + (*call)[1].str()));
    }
    return complaints;
}

Complaints too_long(const SourceFile& file, std::size_t most_lines) {
    const std::size_t lines = lines_of(file.text).size();
    if (lines <= most_lines) return {};
    return {at_line(file, most_lines + 1, std::to_string(lines) + " lines are too long for one file")};
}

Complaints folder_circles(const std::vector<SourceFile>& files) {
    std::map<std::string, Names> sees;
    for (const SourceFile& file : files)
        for (const Include& include : includes_of(file))
            if (include.own && folder_of(include.name) != folder_of(file.path))
                sees[folder_of(file.path)].insert(folder_of(include.name));

    Complaints complaints;
    for (const auto& [start, unused] : sees) {
        Names reached;
        const std::function<void(const std::string&)> visit = [&](const std::string& folder) {
            for (const auto& next : sees[folder])
                if (reached.insert(next).second) visit(next);
        };
        visit(start);
        if (reached.contains(start)) complaints.push_back(start + " includes itself through other folders");
    }
    return complaints;
}

Complaints glances(const std::vector<SourceFile>& files, std::string_view one, std::string_view other) {
    Complaints complaints;
    for (const SourceFile& file : files)
        for (const Include& include : includes_of(file))
            if ((is_in(one, file.path) && is_in(other, include.name)) ||
                (is_in(other, file.path) && is_in(one, include.name)))
                complaints.push_back(file.path + " sees " + std::string(include.name));
    return complaints;
}

Complaints stale_cuts(const SourceFile& document, const std::vector<SourceFile>& files) {
    Complaints complaints;
    const std::string_view text = document.text, opening = "<!-- cut from ", closing = " -->\n```cpp\n";
    for (std::size_t at = text.find(opening); at != text.npos; at = text.find(opening, at + 1)) {
        const std::size_t name = at + opening.size(), name_end = text.find(closing, name);
        const std::size_t code = name_end + closing.size(), code_end = text.find("```\n", code);
        const auto line =
            1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
        if (name_end == text.npos || code_end == text.npos) {
            complaints.push_back(at_line(document, line, "no code follows"));
            continue;
        }
        const auto path = text.substr(name, name_end - name);
        const bool fresh = std::ranges::any_of(files, [&](const SourceFile& file) {
            return file.path == path && file.text.find(text.substr(code, code_end - code)) != file.text.npos;
        });
        if (!fresh) complaints.push_back(at_line(document, line, std::string(path) + " says something else"));
    }
    return complaints;
}

std::string code_only(std::string_view text) {
    std::string code(text);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t comment = end_of_comment(text, i), literal = end_of_literal(text, i);
        if (comment > i)
            blank(code, i, comment);
        else if (literal > i)
            blank(code, i + 1, literal - 1);
        i = std::max({i + 1, comment, literal});
    }
    return code;
}

}  // namespace lightnet::house
