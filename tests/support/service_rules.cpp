#include "tests/support/service_rules.hpp"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace lightnet::test {
namespace {

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what + ": " + std::strerror(errno)); }

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

int family_called(const std::string& name) {
    static const std::map<std::string, int> families{{"AF_UNIX", AF_UNIX},
                                                     {"AF_INET", AF_INET},
                                                     {"AF_INET6", AF_INET6},
                                                     {"AF_NETLINK", AF_NETLINK},
                                                     {"AF_PACKET", AF_PACKET}};
    return families.at(name);
}

// What @system-service lacks, as far as it's likely to be called.
const std::vector<int> not_of_services{
    SYS_mount,         SYS_umount2,           SYS_pivot_root,   SYS_swapon,          SYS_swapoff,
    SYS_reboot,        SYS_init_module,       SYS_finit_module, SYS_delete_module,   SYS_kexec_load,
    SYS_ptrace,        SYS_process_vm_readv,  SYS_bpf,          SYS_perf_event_open, SYS_userfaultfd,
    SYS_acct,          SYS_open_by_handle_at, SYS_quotactl,     SYS_settimeofday,    SYS_clock_settime,
    SYS_clock_adjtime, SYS_adjtimex};

/// A program of the kernel's filter, from rules that are looked at one after the other.
class CallFilter {
public:
    CallFilter() { load(offsetof(seccomp_data, nr)); }
    void refuse(int call, int error) {
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1));
        answer(error);
    }
    /// Where any of these bits is set in an argument.
    void refuse_bits(int call, unsigned argument, unsigned bits, int error) {
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 4));
        load(low_half(argument));
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1));
        answer(error);
        load(offsetof(seccomp_data, nr));
    }
    /// Where all of them are.
    void refuse_all_bits(int call, unsigned argument, unsigned bits, int error) {
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 5));
        load(low_half(argument));
        program_.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, bits));
        program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, bits, 0, 1));
        answer(error);
        load(offsetof(seccomp_data, nr));
    }
    /// Where an argument is none of these.
    void refuse_others(int call, unsigned argument, const std::vector<int>& allowed, int error) {
        const auto count = static_cast<unsigned char>(allowed.size());
        program_.push_back(
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, static_cast<unsigned char>(count + 3)));
        load(low_half(argument));
        for (unsigned char i = 0; i < count; ++i)
            program_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(allowed[i]),
                                        static_cast<unsigned char>(count - i), 0));
        answer(error);
        load(offsetof(seccomp_data, nr));
    }
    void apply() {
        program_.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
        const sock_fprog whole{static_cast<unsigned short>(program_.size()), program_.data()};
        if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &whole) != 0) fail("no filter of system calls");
    }

private:
    static unsigned low_half(unsigned argument) {
        return static_cast<unsigned>(offsetof(seccomp_data, args)) + 8 * argument;  // of a machine that begins with it
    }
    void load(std::size_t at) { program_.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(at))); }
    void answer(int error) {
        program_.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<unsigned>(error)));
    }
    std::vector<sock_filter> program_;
};

void bind_writable(const std::string& folder) {
    if (::mount(folder.c_str(), folder.c_str(), nullptr, MS_BIND, nullptr) != 0) fail(folder);
}

// All that is mounted, but what tells of the system.
std::vector<std::string> mounts() {
    std::ifstream in("/proc/self/mounts");
    std::vector<std::string> found;
    for (std::string line; std::getline(in, line);) {
        const auto at = words_of(line).at(1);
        if (!at.starts_with("/proc") && !at.starts_with("/sys") && !at.starts_with("/dev")) found.push_back(at);
    }
    return found;
}

}  // namespace

ServiceRules::ServiceRules(const std::string& unit_file) {
    std::ifstream in(unit_file);
    if (!in) throw std::runtime_error("no unit at " + unit_file);
    for (std::string line; std::getline(in, line);) {
        const auto equals = line.find('=');
        if (line.empty() || line[0] == '#' || line[0] == '[' || equals == std::string::npos) continue;
        const auto key = line.substr(0, equals), value = line.substr(equals + 1);
        lines_[key] = value;
        if (key == "Environment") environment_.push_back(value);
    }
}

std::string ServiceRules::value(const std::string& key) const {
    const auto found = lines_.find(key);
    return found == lines_.end() ? std::string() : found->second;
}

bool ServiceRules::says(const std::string& key, const std::string& wanted) const { return value(key) == wanted; }

void ServiceRules::protect_files(const std::vector<std::string>& writable) const {
    if (::unshare(CLONE_NEWNS) != 0) return;  // a container that lets nobody mount: its files are the host's no more
    if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) fail("no mounts of its own");
    for (const auto& folder : writable) bind_writable(folder);
    for (const auto& at : mounts()) {
        bool stays = false;
        for (const auto& folder : writable) stays = stays || at == folder;
        if (!stays) ::mount("none", at.c_str(), nullptr, MS_BIND | MS_REMOUNT | MS_RDONLY, nullptr);
    }
    if (::access("/etc", W_OK) == 0) throw std::runtime_error("/etc can still be written");
}

void ServiceRules::filter_calls() const {
    CallFilter filter;
    if (const auto names = words_of(value("RestrictAddressFamilies")); !names.empty()) {
        std::vector<int> families;
        for (const auto& name : names) families.push_back(family_called(name));
        filter.refuse_others(SYS_socket, 0, families, EAFNOSUPPORT);
        filter.refuse_others(SYS_socketpair, 0, families, EAFNOSUPPORT);
    }
    if (says("SystemCallFilter", "@system-service"))
        for (const int call : not_of_services) filter.refuse(call, EPERM);
    if (says("RestrictNamespaces", "yes")) {
        const unsigned spaces = CLONE_NEWNS | CLONE_NEWNET | CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWIPC | CLONE_NEWUTS;
        filter.refuse(SYS_clone3, ENOSYS);
        filter.refuse_bits(SYS_clone, 0, spaces, EPERM);
        filter.refuse_bits(SYS_unshare, 0, spaces, EPERM);
        filter.refuse(SYS_setns, EPERM);
    }
    if (says("RestrictRealtime", "yes"))
        filter.refuse_others(SYS_sched_setscheduler, 1, {SCHED_OTHER, SCHED_BATCH, SCHED_IDLE}, EPERM);
    if (says("RestrictSUIDSGID", "yes")) {
        filter.refuse_bits(SYS_fchmod, 1, S_ISUID | S_ISGID, EPERM);
        filter.refuse_bits(SYS_fchmodat, 2, S_ISUID | S_ISGID, EPERM);
    }
    if (says("LockPersonality", "yes")) filter.refuse(SYS_personality, EPERM);
    if (says("ProtectHostname", "yes")) filter.refuse(SYS_sethostname, EPERM);
    if (says("ProtectKernelLogs", "yes")) filter.refuse(SYS_syslog, EPERM);
    if (says("MemoryDenyWriteExecute", "yes")) {
        filter.refuse_all_bits(SYS_mmap, 2, PROT_WRITE | PROT_EXEC, EPERM);
        filter.refuse_bits(SYS_mprotect, 2, PROT_EXEC, EPERM);
    }
    filter.apply();
}

void ServiceRules::apply(const std::vector<std::string>& writable) const {
    if (says("ProtectSystem", "strict") && ::geteuid() == 0) protect_files(writable);
    constexpr int most_rights = 63;
    if (lines_.contains("CapabilityBoundingSet") && value("CapabilityBoundingSet").empty())
        for (int right = 0; right <= most_rights; ++right) prctl(PR_CAPBSET_DROP, right);
    ::umask(static_cast<mode_t>(std::stoi("0" + value("UMask"), nullptr, 8)));
    if (prctl(PR_SET_NO_NEW_PRIVS, says("NoNewPrivileges", "yes") ? 1 : 0, 0, 0, 0) != 0 &&
        says("NoNewPrivileges", "yes"))
        fail("NoNewPrivileges");
    filter_calls();
}

}  // namespace lightnet::test
