#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <exception>
#include <memory>
#include <utility>

namespace manoscope::serve {

/// Does `work` on a pool, and calls `then` on the thread of the sockets with what it threw, if
/// anything.
/// @param keep  holds all that both use; the pool hands it back, so that it goes on that thread.
template <class Work, class Then>
void run_on(boost::asio::thread_pool& pool, boost::asio::io_context& io, std::shared_ptr<void> keep,
            Work work, Then then) {
  boost::asio::post(pool, [&io, keep = std::move(keep), work = std::move(work),
                           then = std::move(then)]() mutable {
    std::exception_ptr failure;
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    boost::asio::post(
        io, [keep = std::move(keep), then = std::move(then), failure]() mutable { then(failure); });
  });
}

}  // namespace manoscope::serve
