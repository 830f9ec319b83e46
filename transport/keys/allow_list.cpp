#include "transport/keys/allow_list.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"
#include "core/base/words_of.hpp"

namespace lightnet {
namespace {

constexpr auto look_interval = std::chrono::milliseconds(200);
constexpr std::size_t longest_file = 4 << 20, longest_name = 200;

struct ListLine {
    int number = 0;
    std::string_view key, name;
};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<ListLine> lines_in(std::string_view text) {
    std::vector<ListLine> lines;
    for (int number = 1; !text.empty(); ++number) {
        const auto end = std::min(text.find('\n'), text.size());
        const auto line = trimmed(text.substr(0, std::min(text.find('#'), end)));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty()) continue;
        const auto blank = std::min(line.find_first_of(" \t"), line.size());
        lines.push_back({number, line.substr(0, blank), trimmed(line.substr(blank))});
    }
    return lines;
}

bool is_good_name(std::string_view name) {
    if (name.ends_with('*')) name.remove_suffix(1);
    if (name.empty() || name.size() > longest_name) return false;
    for (const unsigned char c : name)
        if (c <= ' ' || c >= 127 || c == '*' || c == '#') return false;
    return true;
}

// "": none.
std::string mistake_in(const ListLine& line) {
    if (auto mistake = mistake_in_key(line.key); !mistake.empty()) return mistake;
    if (line.name.empty()) return "the name of its owner is missing behind this key, as in: KEY anna@onyx1";
    if (!is_good_name(line.name))
        return "a name is one word, like anna@onyx1, not " + in_quotes(std::string(line.name));
    return {};
}

bool is_safe(const struct stat& state) {
    return (state.st_mode & 022) == 0 && (state.st_uid == geteuid() || state.st_uid == 0);
}

// Of both, as much of the one as of the other.
std::string read_list(const std::string& file) {
    const int in = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (in < 0) throw Error(file, std::string("the list of keys can't be read: ") + std::strerror(errno));
    struct stat state {};
    std::string text;
    const bool known = fstat(in, &state) == 0 && S_ISREG(state.st_mode);
    const bool sound = known && is_safe(state);
    if (sound && static_cast<std::size_t>(state.st_size) <= longest_file) {
        text.resize(longest_file);
        const auto size = ::read(in, text.data(), text.size());
        text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    }
    close(in);
    if (!known) throw Error(file, "the list of keys is no file");
    if (!sound) throw Error(file, "others can change this list of keys; it must be yours, and writable by you alone");
    if (static_cast<std::size_t>(state.st_size) > longest_file) throw Error(file, "the list of keys is too long");
    return text;
}

}  // namespace

AllowList AllowList::parse(std::string_view text, const std::string& file) {
    AllowList list;
    std::vector<Problem> problems;
    for (const auto& line : lines_in(text)) {
        auto mistake = mistake_in(line);
        const auto key = PublicKey::from(line.key);
        if (mistake.empty() && list.has(*key)) mistake = "this key stands here twice";
        if (mistake.empty())
            list.add(*key, std::string(line.name));
        else
            problems.push_back({{file, line.number}, mistake});
    }
    if (!problems.empty()) throw UserError(std::move(problems));
    return list;
}

AllowList AllowList::parse_what_can_be(std::string_view text) {
    AllowList list;
    for (const auto& line : lines_in(text))
        if (mistake_in(line).empty()) list.add(*PublicKey::from(line.key), std::string(line.name));
    return list;
}

std::optional<std::string> AllowList::name_of(const PublicKey& key) const {
    const auto found = names_.find(key);
    return found == names_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<PublicKey> AllowList::key_of(const std::string& name) const {
    for (const auto& [key, its_name] : names_)
        if (its_name == name) return key;
    return std::nullopt;
}

std::string AllowList::text() const {
    std::string text;
    for (const auto& [key, name] : names_) text += key.text() + " " + name + "\n";
    return text;
}

std::string called(const std::string& listed, const std::string& said) {
    if (!listed.ends_with('*')) return listed;
    const auto stem = listed.substr(0, listed.size() - 1);
    return said.starts_with(stem) && said.size() > stem.size() ? said : stem;
}

AllowFile::AllowFile(std::string whom) {
    if (const auto key = PublicKey::from(whom)) {
        list_.add(*key, "launcher");
        return;
    }
    file_ = std::move(whom);
    taken_ = seen_ = stamp();
    list_ = read();
}

std::string AllowFile::name() const { return file_.empty() ? "the command line" : file_; }

AllowFile::Stamp AllowFile::stamp() const {
    struct stat state {};
    if (stat(file_.c_str(), &state) != 0) return {};
    return {state.st_mtim.tv_sec,  state.st_mtim.tv_nsec, state.st_size, state.st_ctim.tv_sec,
            state.st_ctim.tv_nsec, state.st_ino,          is_safe(state)};
}

AllowList AllowFile::read() const { return AllowList::parse(read_list(file_), file_); }

bool AllowFile::refresh(std::chrono::steady_clock::time_point now, const std::function<void(const std::string&)>& say) {
    if (file_.empty() || now - looked_ < look_interval) return false;
    looked_ = now;
    const auto before = std::exchange(seen_, stamp());
    if (seen_ == taken_ || (seen_.safe && seen_ != before)) return false;
    taken_ = seen_;
    AllowList list;
    try {
        list = read();
    } catch (const std::exception& error) {
        say(words_of(error) + "; until it is mended nobody is let in");
    }
    if (list == list_) return false;
    list_ = std::move(list);
    return true;
}

}  // namespace lightnet
