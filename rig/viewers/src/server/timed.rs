//! A connection on which nothing lasts longer than it may, however slowly its bytes trickle.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use base::clock::Deadline;

/// A connection, and when what is done with it has to be done. A timeout of the socket alone would begin
/// again with each byte.
#[derive(Debug)]
pub struct Timed {
    stream: TcpStream,
    deadline: Deadline,
}

impl Timed {
    /// A connection that has so long from now on.
    pub fn new(stream: TcpStream, time: Duration) -> Self {
        Self { stream, deadline: Deadline::after(time) }
    }

    /// What is done next has so long from now on.
    pub fn allow(&mut self, time: Duration) {
        self.deadline = Deadline::after(time);
    }

    fn left(&self) -> io::Result<Option<Duration>> {
        self.deadline.left().map(Some).ok_or_else(|| ErrorKind::TimedOut.into())
    }
}

impl Read for Timed {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for Timed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}
