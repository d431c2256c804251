// What readers keep of writers whose participant the library drops for its lease: with Fast DDS
// 2.9.1 a record of each, permanently, by which the same writer would not deliver its samples again
// if it came back; some 370 bytes a process that was killed. Nothing is kept here: a process that
// starts again is another writer, and one that was only cut off for longer than its lease delivers
// what it still holds once more, as one does that said farewell. Does not remove participants, and
// touches no locks.
#pragma once

namespace giveway::link {

// True where the library keeps nothing of them.
bool ForgetsDroppedWriters();

}  // namespace giveway::link
