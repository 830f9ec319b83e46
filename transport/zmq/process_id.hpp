// The id of this process.
#pragma once

namespace lightnet {

/// From now on getpid() asks the system no more than once in each process, forked ones included: ZeroMQ calls it before
/// it sends, receives or waits, to notice forks, and since glibc 2.25 each call is one of the system. What clones this
/// process past the C library (a bare clone(2)) is told its parent's id. Any thread.
void keep_process_id();

}  // namespace lightnet
