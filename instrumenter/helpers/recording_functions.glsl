// Makes room for a record and writes its id; true if its values are to be written from sd_words[sd_at] on.
// What does not fit is only counted. The count stops far below 2^31, so that it never wraps round.
bool sd_record(int id, int words) {
  if (!sd_on) return false;
  int start = sd_wanted;
  if (start < 2000000000) sd_wanted = start + words + 1;
  if (sd_wanted > sd_room) return false;
  sd_words[sd_base + start] = id;
  sd_at = sd_base + start + 1;
  return true;
}

// The thread ends: mark 1 = it ran to its end, 2 = it is about to be discarded.
bool sd_end(int mark) {
  if (sd_on) {
    sd_words[sd_base] = sd_wanted;
    sd_words[sd_base + 3] = mark;
  }
  return true;
}

// This thread is one of those recorded, if there is room; the two numbers tell the session which.
void sd_start(int first, int second) {
  int order = atomicAdd(sd_words[0], 1);
  sd_invocation = order + 1;
  if (order < sd_words[2]) {
    sd_room = sd_words[1];
    sd_base = 4 + order * sd_room;
    sd_wanted = 4;
    sd_words[sd_base + 1] = first;
    sd_words[sd_base + 2] = second;
    sd_on = true;
  }
}
