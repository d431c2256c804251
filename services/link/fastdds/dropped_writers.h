// What readers keep of writers whose participant the library drops for its lease: with Fast DDS
// 2.9.1 a record of each, permanently, so that the same writer would not deliver its samples again
// if it came back; some 370 bytes a process that was killed. Here nobody comes back as the same
// writer, so nothing is kept. Does not remove participants, and touches no locks.
#pragma once

namespace giveway::link {

// True where the library keeps nothing of them.
bool ForgetsDroppedWriters();

}  // namespace giveway::link
