#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lrsm {

/// SHA-256 over a sequence of buffers: what a pass's hash in frame.json and captures is made of.
class Sha256 {
  public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    Sha256& add(std::span<const std::byte> bytes);
    /// The elements' bytes; T must have no padding.
    template <class T>
    Sha256& add(const std::vector<T>& values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        return add(std::as_bytes(std::span(values)));
    }
    Sha256& add(const std::string& text) { return add(std::as_bytes(std::span(text.data(), text.size()))); }
    /// 64 hexadecimal digits; ends the sequence.
    std::string hex();

  private:
    void* context_;
};

}  // namespace lrsm
