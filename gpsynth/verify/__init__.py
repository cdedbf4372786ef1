"""What can be said about a law that was found, beyond the starts it was found on."""
