#pragma once

#include "core/base/json_reader.h"

#include <string_view>
#include <vector>

/// Things of a view file that move: `"keys": [{"time": 0, "position": [0, 0, 0]}, {"time": 2, "position": [1, 0, 0], "yaw": 90}]`.
///
/// A number, or three, of a thing follows the keys that give it, linear in time between them (in double; at a key it is the key's own, to the bit), the first's
/// before them and the last's after them; keys that leave it out are none of its. Times are seconds and increase.
namespace lrsm {

/// Which numbers may have keys.
using KeyedNames = std::vector<std::string_view>;

/// The times of a thing's keys; none where it has no keys. Throws InputError, which names the place, for keys that are not as above, and for a number that both
/// the thing and its keys give.
std::vector<double> keyTimesOf(const JsonReader& thing, const KeyedNames& names);

/// A thing at a moment, to be read as one without keys.
class Moment {
  public:
    /// Throws as keyTimesOf.
    Moment(const JsonReader& thing, const KeyedNames& names, double time);
    Moment(const Moment&) = delete;  // the reader points into it
    Moment& operator=(const Moment&) = delete;
    /// Lives as long as this. Its errors name the time, where there are keys.
    const JsonReader& reader() const { return reader_; }

  private:
    JsonReader::Json json_;  ///< what the reader reads: declared before it
    JsonReader reader_;
};

}  // namespace lrsm
