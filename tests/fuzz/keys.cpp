#include "transport/keys/key.hpp"

#include <stdexcept>

#include "core/base/error.hpp"
#include "tests/fuzz/targets.hpp"
#include "transport/daemon/host_rights.hpp"
#include "transport/keys/allow_list.hpp"
#include "transport/wire/packet.hpp"
#include "transport/wire/rights.hpp"

namespace lightnet::fuzz {
namespace {

// The same on every machine.
PublicKey some_key(unsigned char first) {
    PublicKey key;
    key.bytes.fill(first);
    return key;
}

void read_list(std::span<const std::byte> bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (const auto key = PublicKey::from(text); key && key->text() != text)
        throw std::logic_error("a key has two texts");
    if (PublicKey::from(text).has_value() != mistake_in_key(text).empty()) throw std::logic_error("a key and no key");
    (void)KeyPair::from_secret(text);
    const auto lenient = AllowList::parse_what_can_be(text);
    if (AllowList::parse_what_can_be(lenient.text()) != lenient) throw std::logic_error("a list does not come back");
    try {
        const auto list = AllowList::parse(text, "keys");
        if (AllowList::parse(list.text(), "keys") != list) throw std::logic_error("a list does not come back");
        if (list != lenient) throw std::logic_error("two readings of one list");
    } catch (const UserError&) {
    }
}

std::vector<std::string> list_seeds() {
    const auto one = some_key(1).text(), two = some_key(200).text();
    return {one, one + " anna@onyx1\n", "# who may\n" + one + " anna\n\n" + two + "\tslurm-*  # a farm\r\n"};
}

// Who has no part in a run says nothing in it, whatever he says.
void knock(std::span<const std::byte> bytes) {
    const auto launcher = some_key(1), second = some_key(2), host = some_key(3), stranger = some_key(4);
    static HostRights rights = [&] {
        HostRights made(launcher.text(), second);
        made.serve(launcher.text());
        AllowList members;
        members.add(host, "tcp://onyx1:7777");
        made.use_members(members);
        return made;
    }();
    if (bytes.empty()) return;
    const auto header = packet::peek_header(bytes.subspan(1));
    if (!header) return;
    const std::array keys{launcher.text(), second.text(), host.text(), stranger.text(),
                          std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
    const auto who = static_cast<std::size_t>(bytes[0]) % keys.size();
    const bool of_the_run = header->run == 7;
    if (!rights.may(keys[who], header->type, of_the_run)) return;
    if (who > 2) throw std::logic_error("a stranger is listened to");
    const bool about_the_line = header->type >= packet::Type::part;
    const bool asks = header->type == packet::Type::ask_light || header->type == packet::Type::fetch;
    if (who == 2 && !asks && !about_the_line) throw std::logic_error("a member orders");
    if (who == 1 && (of_the_run || header->type < packet::Type::hello)) throw std::logic_error("a guest orders");
}

std::vector<std::string> gate_seeds() {
    std::vector<std::string> seeds;
    for (std::uint8_t type = 1; type <= static_cast<std::uint8_t>(packet::Type::last); ++type)
        for (char who = 0; who < 5; ++who) {
            const auto packet = packet::pack(static_cast<packet::Type>(type), type % 2 ? 7 : 8, {});
            seeds.push_back(who +
                            std::string(reinterpret_cast<const char*>(packet.header.data()), packet.header.size()));
        }
    return seeds;
}

}  // namespace

Target keys() { return {"keys", read_list, list_seeds}; }
Target gates() { return {"gates", knock, gate_seeds}; }

}  // namespace lightnet::fuzz
