// A USB3 Vision camera in user space, plugged into a USB port of this machine (kernel modules
// dummy_hcd, usb_f_fs; root): usb3_vision_gadget SERIAL. Prints READY. Lines on standard input,
// each answered by DONE: "skip N" (ids), of the next frame "cut N" (bytes that are left) and
// "lose_trailer"; "width N", "unplug", "plug". End of input ends it.
#include <pthread.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

#include "tests/vm/functionfs.h"
#include "tests/vm/usb3_vision_device.h"

namespace {

using namespace std::chrono_literals;
using stipple::FunctionFs;
using stipple::Usb3VisionDevice;

class Gadget {
  public:
    explicit Gadget(const std::string& serial) : usb_(serial), device_(serial) {}

    [[noreturn]] void answer_requests() {
        std::array<std::uint8_t, 1024> request{};
        for (;;) {
            const std::size_t size = usb_.read_request(request);
            if (size == 0) std::this_thread::sleep_for(1ms);  // unplugged
            const auto answer = device_.answer(std::span(request).first(size));
            if (!device_.is_streaming()) end_transfers();
            if (!answer.empty()) usb_.write_answer(answer);
        }
    }

    [[noreturn]] void stream() {
        streamer_ = pthread_self();
        auto due = std::chrono::steady_clock::now();
        for (;;) {
            const std::chrono::duration<double> period(1 / device_.frame_rate_hz());
            due += std::chrono::duration_cast<std::chrono::nanoseconds>(period);
            due = std::max(due, std::chrono::steady_clock::now() - 100ms);
            std::this_thread::sleep_until(due);
            writing_ = true;
            if (device_.is_streaming()) send(device_.next_block());
            writing_ = false;
        }
    }

    [[noreturn]] void watch_cable() {
        for (;;) {
            usb_.wait_for_disconnection();
            device_.stop_streaming();
            end_transfers();
        }
    }

    void obey(const std::string& word, std::uint64_t value) {
        if (word == "skip") device_.skip(value);
        if (word == "cut") device_.cut(value);
        if (word == "lose_trailer") device_.lose_trailer();
        if (word == "width") device_.set_width(static_cast<std::uint32_t>(value));
        if (word == "plug") usb_.plug();
        if (word == "unplug") usb_.unplug();
    }

  private:
    void send(const Usb3VisionDevice::Block& block) {
        static_cast<void>(usb_.write_stream(block.leader) && usb_.write_stream(block.payload) &&
                          (block.trailer.empty() || usb_.write_stream(block.trailer)));
    }

    /// What waits for a host that no longer listens is taken back.
    void end_transfers() {
        while (writing_) {
            if (const pthread_t thread = streamer_; thread != 0) pthread_kill(thread, SIGUSR1);
            std::this_thread::sleep_for(1ms);
        }
    }

    FunctionFs usb_;
    Usb3VisionDevice device_;
    std::atomic<pthread_t> streamer_{0};
    std::atomic<bool> writing_ = false;
};

void wake_up(int) {}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) return 2;
    struct sigaction action {};
    action.sa_handler = wake_up;  // without SA_RESTART: ends a write
    sigaction(SIGUSR1, &action, nullptr);
    try {
        Gadget gadget(arguments[1]);
        std::thread([&] { gadget.answer_requests(); }).detach();
        std::thread([&] { gadget.stream(); }).detach();
        std::thread([&] { gadget.watch_cable(); }).detach();
        gadget.obey("plug", 0);
        std::cout << "READY" << std::endl;
        for (std::string word; std::cin >> word;) {
            std::uint64_t value = 0;
            if (word == "skip" || word == "cut" || word == "width") std::cin >> value;
            gadget.obey(word, value);
            std::cout << "DONE" << std::endl;
        }
        std::_Exit(0);  // the threads go with it
    } catch (const std::exception& e) {
        std::cerr << e.what() << std::endl;
        std::_Exit(1);
    }
}
