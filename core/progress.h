// Progress that a stage reports to its caller, independent of terminals.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

namespace bnvpl {

// What a work knows of itself that its units do not tell.
struct ProgressNote {
  std::optional<double> leftS = {};  // seconds until it ends
  std::optional<double> error = {};  // relative error of the result so far
};

// Called from any thread with the units of work done since the last call. It may be empty.
class ProgressFn {
 public:
  using Count = std::function<void(uint64_t)>;
  using Begin = std::function<void(std::string_view what, uint64_t total)>;
  using End = std::function<void()>;
  using Tell = std::function<void(const ProgressNote&)>;

  ProgressFn() = default;
  template <typename Fn>
  requires(std::constructible_from<Count, Fn> && !std::same_as<std::remove_cvref_t<Fn>, ProgressFn>)
      ProgressFn(Fn count, Begin begin = {}, End end = {},  // NOLINT: any callable is one
                 Tell tell = {})
      : count_(std::move(count)),
        begin_(std::move(begin)),
        end_(std::move(end)),
        tell_(std::move(tell)) {}

  explicit operator bool() const { return static_cast<bool>(count_); }
  void operator()(uint64_t done) const {
    if (count_) count_(done);
  }
  void tell(const ProgressNote& note) const {
    if (tell_) tell_(note);
  }

  // Work that is counted separately, such as preparations. It ends with the lifetime of this
  // object. Only one may exist at a time.
  class [[nodiscard]] Phase {
   public:
    explicit Phase(const End* end) : end_(end) {}
    Phase(const Phase&) = delete;
    Phase& operator=(const Phase&) = delete;
    ~Phase() {
      if (end_ && *end_) (*end_)();
    }

   private:
    const End* end_;
  };
  // During the lifetime of the Phase, calls count towards `total` units of `what` ("radii"). The
  // ProgressFn must outlive it.
  Phase beginPhase(std::string_view what, uint64_t total) const {
    if (begin_) begin_(what, total);
    return Phase(&end_);
  }

 private:
  Count count_;
  Begin begin_;
  End end_;
  Tell tell_;
};

}  // namespace bnvpl
