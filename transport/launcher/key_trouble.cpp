#include "transport/launcher/key_trouble.hpp"

namespace lightnet {

KeyTrouble key_trouble(const std::string& endpoint, const std::optional<LineKeys>& keys, Handshake seen) {
    const auto way = "say which key it has, as in place \"" + endpoint +
                     "\" { key = \"…\" } of a hosts file (lightnetd --print-key shows it there)";
    if (!keys && seen == Handshake::abandoned)
        return {"does not answer: each connection to it breaks off before a word is said", "if it has a key, " + way};
    if (!keys) return {"wants a key", way};
    if (seen == Handshake::refused)
        return {"does not know our key (fingerprint " + keys->own.open.fingerprint() + ")",
                "to be let in, append this line to its list (lightnetd --allow): " + keys->own.open.text() + " NAME"};
    return {"has another key than expected (fingerprint " + keys->theirs.fingerprint() + "), or none",
            "lightnetd --print-key shows it there"};
}

}  // namespace lightnet
