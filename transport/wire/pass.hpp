// The proof that a host knows a secret of the run's user, by which it is let into a run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lightnet {

/// A pre-shared key in a file that only its user can read. It never travels: who joins proves that he knows it, by the
/// response to one challenge, under one name. A value.
class Pass {
public:
    /// From a file; made there, when it is missing, with 32 random bytes. Throws Error when others could read it, or it
    /// can't be made.
    static Pass of(const std::string& file);
    /// Where it lies when the user says nothing: $LIGHTNET_PASS, else below ~/.config/lightnet. Throws Error when there
    /// is no such folder.
    static std::string usual_file();
    explicit Pass(std::string secret) : secret_(std::move(secret)) {}

    /// Whoever joins: under this name, as this process, to be called there ("": not at all).
    struct Claim {
        std::string name;
        std::uint64_t process = 0;
        std::string endpoint;
    };
    /// HMAC-SHA-256 over the challenge and all of the claim, in hexadecimal digits.
    std::string proof(std::string_view challenge, const Claim& claim) const;
    bool proves(std::string_view challenge, const Claim& claim, std::string_view proof) const;

private:
    std::string secret_;
};

/// 32 random hexadecimal digits that nobody can foresee.
std::string random_challenge();

}  // namespace lightnet
