// Errors in words: the user's, a node's, the machine's.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lightnet {

/// Where in the user's files something stands. Line 0: the file as a whole.
struct SourceLine {
    std::string file;
    int line = 0;
    friend bool operator==(const SourceLine&, const SourceLine&) = default;
};

/// One thing that is wrong: where, and what would be right.
struct Problem {
    SourceLine where;
    std::string
        what;  // lower case, no full stop: "PhotonMap 'caustics': unknown parameter 'photns' (did you mean 'photons'?)"
    friend bool operator==(const Problem&, const Problem&) = default;
};

/// "cornell.lua:7: what", with nothing that would command a terminal.
std::string to_string(const Problem& problem);

/// The user's mistake (exit code 2): all that is wrong, at once.
class UserError : public std::runtime_error {
public:
    explicit UserError(std::vector<Problem> problems);
    UserError(SourceLine where, std::string what)
        : UserError(std::vector<Problem>{{std::move(where), std::move(what)}}) {}
    const std::vector<Problem>& problems() const { return problems_; }

private:
    std::vector<Problem> problems_;
};

/// The run failed (exit code 1): what went wrong, and where ("bounce on onyx2"). What it quotes of files commands no
/// terminal.
class Error : public std::runtime_error {
public:
    Error(const std::string& where, const std::string& what) : Error(where + ": " + what) {}
    explicit Error(const std::string& what);
};

/// An Error that names the node and the question already, and the host on which it happened; "": this one.
class NodeError : public Error {
public:
    explicit NodeError(const std::string& what, std::string host = {}) : Error(what), host_(std::move(host)) {}
    NodeError(const std::string& where, const std::string& what, std::string host)
        : Error(where, what), host_(std::move(host)) {}
    const std::string& host() const { return host_; }

private:
    std::string host_;
};

}  // namespace lightnet
