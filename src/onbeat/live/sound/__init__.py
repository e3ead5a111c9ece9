"""What is heard: a microphone, a file or samples, brought to ticks of one rate."""
