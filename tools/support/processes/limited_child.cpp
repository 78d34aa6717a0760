#include "tools/support/processes/limited_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

// The address sanitizer reserves far more address space than any limit would allow.
#if defined(__SANITIZE_ADDRESS__)
#define SPRUNG_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SPRUNG_ADDRESS_SANITIZER 1
#endif
#endif

namespace sprung::support {

namespace {

// The first byte that the child sends; without one it did not come to an end.
enum Ending : char { kResult = 'r', kException = 'e', kOutOfMemory = 'm' };

constexpr int kPollMilliseconds = 200;

void limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  rlimit old{};
  ::getrlimit(resource, &old);
  const rlimit limits{.rlim_cur = std::min(soft, old.rlim_max), .rlim_max = std::min(hard, old.rlim_max)};
  ::setrlimit(resource, &limits);
}

#ifndef SPRUNG_ADDRESS_SANITIZER
// Address space of this process [bytes]; 0 where the system does not say.
rlim_t find_address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}
#endif

void apply_limits(const ChildLimits& limits) {
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
  limit(RLIMIT_CPU, limits.processor_seconds, limits.processor_seconds + 1);
#ifndef SPRUNG_ADDRESS_SANITIZER
  const rlim_t address_space = find_address_space() + limits.memory_bytes;
  limit(RLIMIT_AS, address_space, address_space);
#endif
}

void prepare_child(pid_t parent, const ChildLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // killed before the line above
  // A terminal sends these to the whole group: the parent decides.
  for (const int signal : {SIGINT, SIGHUP, SIGTERM, SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
  for (const int signal : {SIGXCPU, SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  apply_limits(limits);
}

void write_all(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

void send(int output, Ending ending, const std::string& bytes) {
  const char first = ending;
  write_all(output, &first, 1);
  write_all(output, bytes.data(), bytes.size());
}

[[noreturn]] void run_child(int output, const std::function<std::string()>& work) {
  try {
    send(output, kResult, work());
  } catch (const std::bad_alloc&) {
    send(output, kOutOfMemory, {});
  } catch (const std::length_error&) {  // more than any memory holds
    send(output, kOutOfMemory, {});
  } catch (const std::exception& error) {
    send(output, kException, error.what());
  } catch (...) {
    send(output, kException, "an exception of unknown type");
  }
  ::_exit(0);
}

// The child from the parent's side; killed and waited for, whatever happens.
class Child {
 public:
  Child(pid_t id, int output) : id_(id), output_(output) {}
  ~Child() {
    ::close(output_);
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int output() const { return output_; }
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_;
  int output_;
};

// Everything the child sends, up to its end.
std::string receive(std::string_view name, const Child& child, const ChildLimits& limits) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::seconds(10 * limits.processor_seconds);
  std::string bytes;
  std::array<char, 1 << 16> buffer{};
  for (;;) {
    if (Clock::now() > end) {
      throw ChildFailure(fmt::format("{} came to no end within {} s", name, 10 * limits.processor_seconds));
    }
    pollfd ready{.fd = child.output(), .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, kPollMilliseconds) <= 0) continue;
    const ssize_t size = ::read(child.output(), buffer.data(), buffer.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(size));
  }
}

std::string describe_end(std::string_view name, int status, const ChildLimits& limits) {
  if (!WIFSIGNALED(status)) return fmt::format("{} ended without a word", name);
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU || signal == SIGKILL) {
    return fmt::format("{} was stopped, after {} s of processor time or for want of memory", name,
                       limits.processor_seconds);
  }
  return fmt::format("{} crashed ({})", name, ::strsignal(signal));
}

std::string take_result(std::string_view name, const std::string& bytes, const ChildLimits& limits) {
  if (bytes[0] == kOutOfMemory) {
    throw ChildFailure(fmt::format("{} asked for more than {:.1f} GiB of memory", name,
                                   static_cast<double>(limits.memory_bytes) / (std::size_t{1} << 30U)));
  }
  if (bytes[0] != kResult) throw ChildFailure(bytes.substr(1));
  return bytes.substr(1);
}

}  // namespace

std::string run_in_limited_child(std::string_view name, const std::function<std::string()>& work,
                                 const ChildLimits& limits) {
  const auto no_process = [&] {
    return ChildFailure(fmt::format("no process for {}: {}", name, std::strerror(errno)));
  };
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw no_process();
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id == 0) {
    ::close(ends[0]);
    prepare_child(parent, limits);
    run_child(ends[1], work);
  }
  Child child(id, ends[0]);
  if (id < 0) {
    const ChildFailure failure = no_process();
    ::close(ends[1]);
    throw failure;
  }
  ::close(ends[1]);
  const std::string bytes = receive(name, child, limits);
  const int status = child.wait();
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !bytes.empty();
  if (!ended) throw ChildFailure(describe_end(name, status, limits));
  return take_result(name, bytes, limits);
}

}  // namespace sprung::support
